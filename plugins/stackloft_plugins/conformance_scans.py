"""Small scans for the conformance kit: a disc that moves, and volumes that the kit makes up.

What is handed in as `told` is a `stackloft.testing.conformance.told_volume.ToldVolume`.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from stackloft.testing.phantoms.scan_grid import ScanGrid
from stackloft.testing.phantoms.scan_volume import ScanVolume

if TYPE_CHECKING:
    from stackloft.testing.conformance.told_volume import ToldVolume

_TURN = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])
_NRRD_TYPES = {"u1": "uint8", "i2": "int16", "u2": "uint16", "f4": "float"}


def disc(slices: int) -> ScanVolume:
    """Return a scan of discs that all differ, turned and far from the origin."""
    rows, columns = np.mgrid[-20:40, -25:55]
    pictures = []
    for k in range(slices):
        inside = rows**2 + (columns - k % 7) ** 2 < (9 + k % 5) ** 2
        noise = np.random.default_rng(k).normal(0, 9, rows.shape)
        pictures.append((np.where(inside, 40, -1000) + noise).astype(np.int16))
    z = 2.5 * np.arange(slices, dtype=np.float64) - 31.7
    grid = ScanGrid(z, 2.5, np.array([-12.3, 8.1]), (60, 80), (0.7, 0.4), 0.0)
    return ScanVolume("disc", tuple(pictures), grid, _TURN, np.array([3.3, -71.0, 12.9]))


def write_dicom_folder(folder: Path, slices: int) -> Path:
    """Write one DICOM file for each slice."""
    from stackloft.testing.phantoms.scan_dicom import write_dicom  # noqa: PLC0415 - it needs pydicom

    write_dicom(disc(slices), folder)
    return folder


def write_dicom_bare(folder: Path, slices: int) -> Path:
    """Write the same without the pixels' size."""
    import pydicom  # noqa: PLC0415 - slow to import

    for path in write_dicom_folder(folder, slices).iterdir():
        data = pydicom.dcmread(path)
        del data.PixelSpacing
        data.save_as(path)
    return folder


def write_dicom_told(folder: Path, told: ToldVolume) -> Path:
    """Write whole grey levels of at most 16 bits, wherever they lie."""
    from stackloft.testing.phantoms.scan_dicom import classic, encoded  # noqa: PLC0415 - it needs pydicom

    kind = _kind(told, "u1", "i2", "u2")
    for k, picture in enumerate(told.pictures):
        data = classic(_scan(told, np.zeros(told.pictures.shape, np.int16)), k)
        bits = 8 * picture.dtype.itemsize
        data.BitsAllocated, data.BitsStored, data.HighBit = bits, bits, bits - 1
        data.PixelRepresentation, data.RescaleIntercept = int(kind == "i2"), "0"
        data.PixelData = picture.astype(f"<{kind}").tobytes()
        content = encoded(data, "big-endian" if picture.dtype.str[0] == ">" else "explicit")
        (folder / f"slice_{k + 1}").write_bytes(content)
    return folder


def write_bruker_folder(folder: Path, slices: int) -> Path:
    """Write a ParaVision reconstruction."""
    from stackloft.testing.phantoms.scan_bruker import write_bruker  # noqa: PLC0415 - as its neighbours

    write_bruker(disc(slices), folder)
    return folder


def write_bruker_bare(folder: Path, slices: int) -> Path:
    """Write the same without the pictures' extent."""
    path = write_bruker_folder(folder, slices) / "visu_pars"
    path.write_text(path.read_text().replace("##$VisuCoreExtent=", "##$VisuCoreOther="))
    return folder


def write_bruker_told(folder: Path, told: ToldVolume) -> Path:
    """Write signed numbers wherever they lie."""
    from stackloft.testing.phantoms.scan_bruker import write_bruker  # noqa: PLC0415 - as its neighbours

    if _kind(told, "i2") and told.pictures.dtype.str[0] == ">":
        raise NotImplementedError("big-endian numbers (the phantom's writer does not)")
    write_bruker(_scan(told, told.pictures.astype(np.int16)), folder)
    return folder


def write_segments(folder: Path, slices: int) -> Path:
    """Write a DICOM segmentation."""
    from stackloft.testing.phantoms.scan_seg import write_dicom_seg  # noqa: PLC0415 - it needs pydicom

    return write_dicom_seg(disc(slices), folder)[0]


def write_structures(folder: Path, slices: int) -> Path:
    """Write a DICOM structure set: rings that differ from each other."""
    from stackloft.testing.phantoms import structure_set as rs  # noqa: PLC0415 - it needs pydicom

    turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.column_stack([np.cos(turn), np.sin(turn)])
    data = rs.structure_set()
    rings = [np.column_stack([(10 + k % 3) * ring, np.full(24, 2.5 * k)]) for k in range(slices)]
    rs.add_region(data, 1, "rings", rings)
    path = folder / "RS"
    path.write_bytes(rs.structure_bytes(data))
    return path


def write_nrrd(folder: Path, slices: int) -> Path:
    """Write one NRRD file, its numbers as they are."""
    volume = disc(slices)
    return _nrrd(folder / "scan.nrrd", np.stack(volume.slices), _frame(volume))


def write_nrrd_bare(folder: Path, slices: int) -> Path:
    """Write the same without saying how large a voxel is."""
    return _nrrd(folder / "scan.nrrd", np.stack(disc(slices).slices), {})


def write_nrrd_told(folder: Path, told: ToldVolume) -> Path:
    """Write numbers of every kind, on upright or turned axes."""
    if not told.even:
        raise NotImplementedError("slices at unequal distances")
    if told.shear:
        raise NotImplementedError("slices that are shifted against each other")
    _kind(told, *_NRRD_TYPES)
    pitch = float(told.positions[1] - told.positions[0])
    steps = told.axes * np.array([told.spacing[1], told.spacing[0], pitch])
    frame = {
        "space": "left-posterior-superior",
        "space directions": " ".join(map(_vector, steps.T)),
        "space origin": _vector(told.origin),
    }
    return _nrrd(folder / "scan.nrrd", told.pictures, frame)


def write_tiff_stack(folder: Path, slices: int) -> Path:
    """Write one TIFF file with a page for each slice."""
    from stackloft.testing.phantoms.scan_tiff import write_tiff  # noqa: PLC0415 - it needs tifffile

    return write_tiff(disc(slices), folder)[0]


def write_tiff_bare(folder: Path, slices: int) -> Path:
    """Write the same with a screen's resolution for all that is known."""
    import tifffile  # noqa: PLC0415 - slow to import

    values = np.stack(disc(slices).slices).astype(np.float32)
    tifffile.imwrite(folder / "scan.tif", values, resolution=(72, 72))
    return folder / "scan.tif"


def write_tiff_told(folder: Path, told: ToldVolume) -> Path:
    """Write numbers of every kind, upright at the origin."""
    import tifffile  # noqa: PLC0415 - slow to import

    _upright(told)
    _kind(told, "u1", "i2", "u2", "f4")
    sizes = {"Z": told.positions[1] - told.positions[0], "Y": told.spacing[0], "X": told.spacing[1]}
    about: dict[str, Any] = {"axes": "ZYX"}
    for axis, size in sizes.items():
        about |= {f"PhysicalSize{axis}": float(size), f"PhysicalSize{axis}Unit": "mm"}
    order: Literal[">", "<"] = ">" if told.pictures.dtype.str[0] == ">" else "<"
    path = folder / "scan.ome.tif"
    tifffile.imwrite(path, told.pictures, ome=True, metadata=about, byteorder=order)
    return path


def write_npz_told(folder: Path, told: ToldVolume) -> Path:
    """Write numbers of every kind in either order, upright at the origin, with their spacing."""
    _upright(told)
    spacing = [float(told.positions[1] - told.positions[0]), *told.spacing]
    np.savez(folder / "volume.npz", volume=told.pictures, spacing=spacing)
    return folder / "volume.npz"


def _upright(told: ToldVolume) -> None:
    if not told.even:
        raise NotImplementedError("slices at unequal distances")
    if told.placed:
        raise NotImplementedError("where a volume lies")


def _kind(told: ToldVolume, *held: str) -> str:
    """Return the kind of numbers; refuse those that the format does not hold, and another memory order."""
    kind = told.pictures.dtype.str[1:]
    if kind not in held:
        raise NotImplementedError(f"numbers of the kind {kind}")
    if not told.pictures.flags.c_contiguous:
        raise NotImplementedError("slices stored column by column")
    return kind


def _scan(told: ToldVolume, values: NDArray[np.int16]) -> ScanVolume:
    shape = values.shape[1], values.shape[2]
    grid = ScanGrid(told.positions, 1.0, np.zeros(2), shape, told.spacing, told.shear)
    return ScanVolume("told", tuple(values), grid, told.axes, told.origin)


def _frame(volume: ScanVolume) -> dict[str, str]:
    row, column = volume.grid.spacing
    steps = volume.turn * np.array([column, row, volume.pitch() if len(volume.slices) > 1 else 2.5])
    return {
        "space": "left-posterior-superior",
        "space directions": " ".join(map(_vector, steps.T)),
        "space origin": _vector(volume.corner(0)),
    }


def _nrrd(path: Path, values: NDArray[Any], frame: Mapping[str, str]) -> Path:
    said = {
        "type": _NRRD_TYPES[values.dtype.str[1:]],
        "dimension": "3",
        **frame,
        "sizes": " ".join(map(str, values.shape[::-1])),
        "endian": "big" if values.dtype.str[0] == ">" else "little",
        "encoding": "raw",
    }
    head = "NRRD0004\n" + "".join(f"{key}: {value}\n" for key, value in said.items()) + "\n"
    path.write_bytes(head.encode("ascii") + values.tobytes())
    return path


def _vector(values: NDArray[np.float64]) -> str:
    return f"({','.join(repr(float(x)) for x in values)})"
