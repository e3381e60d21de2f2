"""A scan as NRRD or NIfTI, written by SimpleITK."""

from __future__ import annotations

import secrets
from pathlib import Path

import numpy as np

from stackloft.model.errors import OutputError
from stackloft.testing.phantoms.scan_volume import ScanVolume


def write_nrrd(volume: ScanVolume, folder: Path) -> list[Path]:
    """Write ``scan.nrrd``; return it in a list."""
    return [_write(volume, folder / "scan.nrrd")]


def write_nifti(volume: ScanVolume, folder: Path) -> list[Path]:
    """Write ``scan.nii.gz``; return it in a list."""
    return [_write(volume, folder / "scan.nii.gz")]


def write_mha(volume: ScanVolume, folder: Path) -> list[Path]:
    """Write ``scan.mha``; return it in a list."""
    return [_write(volume, folder / "scan.mha")]


def _write(volume: ScanVolume, path: Path) -> Path:
    """Write to a hidden neighbour, which then takes the file's name in one step; return `path`.

    Raises
    ------
    OutputError
        The system refuses.
    """
    import SimpleITK as sitk  # noqa: N813, PLC0415 - slow to import, only where scans are written

    values = np.stack(volume.slices)
    image = sitk.GetImageFromArray(values.astype(np.uint8) if volume.label else values)
    row, column = volume.grid.spacing
    image.SetSpacing((column, row, volume.pitch()))  # type: ignore[no-untyped-call]
    image.SetOrigin(tuple(float(x) for x in volume.corner(0)))  # type: ignore[no-untyped-call]
    image.SetDirection(tuple(float(x) for x in volume.turn.ravel()))  # type: ignore[no-untyped-call]
    neighbour = path.with_name(f".{secrets.token_hex(4)}.{path.name}")
    try:
        sitk.WriteImage(image, str(neighbour), useCompression=True)
        neighbour.replace(path)
    except (OSError, RuntimeError) as error:
        raise OutputError("cannot be written", where=str(path), fix="give another folder") from error
    finally:
        neighbour.unlink(missing_ok=True)
    return path
