"""Scans to read: made once, changed file by file."""

import shutil
from pathlib import Path

import numpy as np
import pydicom
import pytest

from stackloft.testing.phantoms.scan_dicom import write_dicom
from stackloft.testing.phantoms.scan_grid import ScanGrid
from stackloft.testing.phantoms.scan_volume import ScanVolume

ORIGIN = np.array([3.3, -71.0, 12.9])
TURN = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])


def make_scan(slices=8, positions=None, thickness=2.5, tilt=0.0, size=(24, 31), **changes):
    """A disc that moves from slice to slice, on an odd grid in an odd place."""
    rows, columns = np.mgrid[: size[0], : size[1]]
    pictures = tuple(
        np.where(np.hypot(rows - 12, columns - 12 - k % 7) < 6 + k % 3, 40 + k, -1000).astype(np.int16)
        for k in range(slices)
    )
    z = 2.5 * np.arange(slices) - 31.7 if positions is None else np.array(positions)
    shear = float(np.tan(np.radians(tilt)))
    grid = ScanGrid(z, thickness, np.array([-12.3, 8.1]), size, (0.7, 0.4), shear)
    return ScanVolume("disc", pictures, grid, TURN, ORIGIN, **changes)


@pytest.fixture(scope="session")
def eight(tmp_path_factory):
    folder = tmp_path_factory.mktemp("eight")
    write_dicom(make_scan(), folder)
    return folder


@pytest.fixture
def series(eight, tmp_path):
    """A folder of eight slices to spoil; IM0008 lies lowest, IM0001 highest."""
    folder = tmp_path / "series"
    shutil.copytree(eight, folder)
    return folder


def edited(path, target=None, **elements):
    """Rewrite a DICOM file with other elements; None deletes one."""
    data = pydicom.dcmread(path)
    for name, value in elements.items():
        if value is None:
            delattr(data, name)
        else:
            setattr(data, name, value)
    data.save_as(Path(target or path))
    return data


@pytest.fixture(scope="session")
def scan():
    return make_scan


@pytest.fixture(scope="session")
def edit():
    return edited
