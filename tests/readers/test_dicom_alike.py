"""Files of a series are read as the one before; each gives what it gives alone."""

from dataclasses import asdict

import numpy as np
import pydicom
import pytest

from stackloft_plugins.readers import dicom_frames
from stackloft_plugins.readers.dicom_frames import read_frames


def same(one, other):
    a, b = asdict(one), asdict(other)
    return a.keys() == b.keys() and all(np.array_equal(a[key], b[key]) for key in a)


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"RescaleIntercept": "-1000"},
        {"SliceThickness": "1.25"},
        {"PixelSpacing": ["0.71", "0.4"]},
        {"ImageOrientationPatient": ["1", "0", "0", "0", "1", "0"]},
        {"SeriesInstanceUID": "1.2.3"},
        {"AcquisitionNumber": "7"},
        {"SliceLocation": "3.5"},
        {"SliceLocation": None},
        {"InstanceNumber": "1234"},
        {"InstanceNumber": None},
        {"ImagePositionPatient": ["1", "2.25", "-3"]},
        {"ImageType": ["ORIGINAL", "PRIMARY", "LOCALIZER"]},
        {"PatientComments": "a longer header"},
    ],
    ids=lambda change: "-".join(change) or "nothing",
)
def test_every_frame_is_the_one_that_its_file_gives_alone(series, change, edit):
    paths = sorted(series.iterdir())
    there = {
        name: value
        for name, value in change.items()
        if value is not None or name in pydicom.dcmread(paths[3])
    }
    edit(paths[3], **there)
    together = list(read_frames(paths))
    alone = [frame for path in paths for frame in read_frames([path])]
    assert len(together) == 8
    assert all(map(same, together, alone))
    assert all(frame.samples_at is not None for frame in together)


def test_what_the_slices_share_is_worked_out_once(series, monkeypatch):
    worked_out = []
    real = dicom_frames.frames_of
    monkeypatch.setattr(dicom_frames, "frames_of", lambda *args: worked_out.append(args) or real(*args))
    assert len(list(read_frames(sorted(series.iterdir())))) == 8
    assert len(worked_out) == 1
