"""The readers of scans pass the kit that strangers run."""

import cv2  # noqa: F401 - its import changes the environment, which the kit watches
import numpy as np
import pydicom
import pytest
import SimpleITK
import tifffile

from stackloft.registry import find
from stackloft.testing.conformance.reader_case import ReaderCase
from stackloft.testing.conformance.reader_checks import reader_checks
from stackloft.testing.phantoms.scan_bruker import write_bruker
from stackloft.testing.phantoms.scan_dicom import write_dicom
from stackloft.testing.phantoms.scan_grid import ScanGrid
from stackloft.testing.phantoms.scan_itk import write_mha, write_nifti, write_nrrd
from stackloft.testing.phantoms.scan_seg import write_dicom_seg
from stackloft.testing.phantoms.scan_tiff import write_tiff
from stackloft.testing.phantoms.scan_volume import ScanVolume
from stackloft.testing.phantoms.structure_set import add_region, structure_bytes, structure_set


def volume(slices, **changes):
    rows, columns = np.mgrid[:60, :80]
    pictures = tuple(
        np.where((rows - 20) ** 2 + (columns - 25 - k % 7) ** 2 < (9 + k % 5) ** 2, 40, -1000).astype(
            np.int16
        )
        + np.random.default_rng(k).normal(0, 9, rows.shape).astype(np.int16)
        for k in range(slices)
    )
    grid = ScanGrid(2.5 * np.arange(slices) - 31.7, 2.5, np.array([-12.3, 8.1]), (60, 80), (0.7, 0.4), 0.0)
    turn = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])
    return ScanVolume("disc", pictures, grid, turn, np.array([3.3, -71.0, 12.9]), **changes)


def dicom(**changes):
    def write(folder, slices):
        files = write_dicom(volume(slices, **changes), folder)
        return files[0] if changes.get("multiframe") else folder

    return write


def dicom_without_spacing(folder, slices):
    for path in write_dicom(volume(slices), folder):
        data = pydicom.dcmread(path)
        del data.PixelSpacing
        data.save_as(path)
    return folder


def itk(write, packed=True):
    def write_one(folder, slices):
        path = write(volume(slices), folder)[0]
        if not packed:
            SimpleITK.WriteImage(SimpleITK.ReadImage(str(path)), str(path), useCompression=False)
        return path

    return write_one


def nrrd_without_spacing(folder, slices):
    path = itk(write_nrrd, packed=False)(folder, slices)
    head, body = path.read_bytes().split(b"\n\n", 1)
    lines = [line for line in head.split(b"\n") if not line.startswith((b"space", b"kinds"))]
    path.write_bytes(b"\n".join(lines) + b"\n\n" + body)
    return path


def tiff(folder, slices):
    return write_tiff(volume(slices), folder)[0]


def tiff_without_spacing(folder, slices):
    path = folder / "scan.tif"
    tifffile.imwrite(path, np.stack(volume(slices).slices).astype(np.float32), resolution=(72, 72))
    return path


def tiff_folder(folder, slices):
    for k, picture in enumerate(volume(slices).slices):
        tifffile.imwrite(folder / f"{k}.tif", picture.astype(np.float32))
    return folder


def npy(folder, slices):
    np.save(folder / "volume.npy", np.stack(volume(slices).slices))
    return folder / "volume.npy"


def npz(folder, slices):
    np.savez_compressed(folder / "volume.npz", ct=np.stack(volume(slices).slices), spacing=[2.5, 0.7, 0.4])
    return folder / "volume.npz"


def npz_without_spacing(folder, slices):
    np.savez(folder / "volume.npz", np.stack(volume(slices).slices))
    return folder / "volume.npz"


def bruker(folder, slices):
    write_bruker(volume(slices), folder)
    return folder


def bruker_without_spacing(folder, slices):
    path = bruker(folder, slices) / "visu_pars"
    path.write_text(path.read_text().replace("##$VisuCoreExtent=", "##$VisuCoreOther="))
    return folder


def dicom_seg(folder, slices):
    return write_dicom_seg(volume(slices), folder)[0]


def rtstruct(folder, slices):
    data = structure_set()
    turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    rings = [(10 + k % 3) * np.column_stack([np.cos(turn), np.sin(turn)]) for k in range(slices)]
    add_region(
        data, 1, "rings", [np.column_stack([ring, np.full(24, 2.5 * k)]) for k, ring in enumerate(rings)]
    )
    path = folder / "RS"
    path.write_bytes(structure_bytes(data))
    return path


GIVEN = {"pixel_size": "0.3mm", "thickness": "2.5mm"}
DICOM = find("reader", "dicom").plugin
ITK, TIFF, NUMPY = (find("reader", name).plugin for name in ("itk", "tiff", "numpy"))
BRUKER, SEG, RTSTRUCT = (find("reader", name).plugin for name in ("bruker", "dicom-seg", "rtstruct"))
CASES = {
    "classic": ReaderCase(DICOM, dicom(), without_spacing=dicom_without_spacing),
    "multiframe": ReaderCase(DICOM, dicom(multiframe=True)),
    "rle": ReaderCase(DICOM, dicom(syntax="rle")),
    "jpeg-ls": ReaderCase(DICOM, dicom(syntax="jpeg-ls")),
    "jpeg-2000": ReaderCase(DICOM, dicom(syntax="jpeg-2000")),
    "deflated": ReaderCase(DICOM, dicom(syntax="deflated")),
    "nrrd": ReaderCase(ITK, itk(write_nrrd), without_spacing=nrrd_without_spacing),
    "nrrd-raw": ReaderCase(ITK, itk(write_nrrd, packed=False)),
    "mha": ReaderCase(ITK, itk(write_mha)),
    "mha-raw": ReaderCase(ITK, itk(write_mha, packed=False)),
    "nifti": ReaderCase(ITK, itk(write_nifti)),
    "tiff": ReaderCase(TIFF, tiff, without_spacing=tiff_without_spacing),
    "tiff-folder": ReaderCase(TIFF, tiff_folder, GIVEN, tuple(GIVEN)),
    "npy": ReaderCase(NUMPY, npy, GIVEN, tuple(GIVEN)),
    "bruker": ReaderCase(BRUKER, bruker, without_spacing=bruker_without_spacing),
    "dicom-seg": ReaderCase(SEG, dicom_seg),
    "rtstruct": ReaderCase(RTSTRUCT, rtstruct),
    "npz": ReaderCase(NUMPY, npz, without_spacing=npz_without_spacing),
}
WHOLE = {"read-small-memory": "a packed volume is unpacked whole, first to tell labels from grey levels"}
UNPACKED = dict.fromkeys(("npz", "nrrd", "mha", "nifti"), WHOLE)
CHECKS = [check.name for check in reader_checks(CASES["classic"])]


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("check", CHECKS)
def test_scans(name, check):
    next(each for each in reader_checks(CASES[name], UNPACKED.get(name)) if each.name == check)()
