"""The readers of scans pass the kit that strangers run."""

import numpy as np
import pydicom
import pytest

from stackloft.registry import find
from stackloft.testing.conformance.reader_case import ReaderCase
from stackloft.testing.conformance.reader_checks import reader_checks
from stackloft.testing.phantoms.scan_dicom import write_dicom
from stackloft.testing.phantoms.scan_grid import ScanGrid
from stackloft.testing.phantoms.scan_volume import ScanVolume


def volume(slices, **changes):
    rows, columns = np.mgrid[:40, :52]
    pictures = tuple(
        np.where((rows - 20) ** 2 + (columns - 25 - k % 7) ** 2 < (9 + k % 5) ** 2, 40, -1000).astype(
            np.int16
        )
        + np.random.default_rng(k).normal(0, 9, rows.shape).astype(np.int16)
        for k in range(slices)
    )
    grid = ScanGrid(2.5 * np.arange(slices) - 31.7, 2.5, np.array([-12.3, 8.1]), (40, 52), (0.7, 0.4), 0.0)
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


DICOM = find("reader", "dicom").plugin
CASES = {
    "classic": ReaderCase(DICOM, dicom(), without_spacing=dicom_without_spacing),
    "multiframe": ReaderCase(DICOM, dicom(multiframe=True)),
    "rle": ReaderCase(DICOM, dicom(syntax="rle")),
    "jpeg-ls": ReaderCase(DICOM, dicom(syntax="jpeg-ls")),
    "jpeg-2000": ReaderCase(DICOM, dicom(syntax="jpeg-2000")),
    "deflated": ReaderCase(DICOM, dicom(syntax="deflated")),
}
CHECKS = [check.name for check in reader_checks(CASES["classic"])]


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("check", CHECKS)
def test_scans(name, check):
    next(each for each in reader_checks(CASES[name]) if each.name == check)()
