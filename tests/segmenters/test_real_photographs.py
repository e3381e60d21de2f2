"""Cryosections of the Visible Human (JPEG, white background), where they are at hand."""

from pathlib import Path

import numpy as np
import pytest

from stackloft.sectioning.contour_sink import trace_stack
from stackloft_plugins.readers.photos import PhotosReader
from stackloft_plugins.segmenters.histogram import HistogramSegmenter

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "real" / "visible_human_photos"

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the photographs are not here")


@pytest.mark.parametrize(
    ("first", "last", "count"), [("1020.jpg", "1215.jpg", 40), ("1020.jpg", "1300.jpg", 57)]
)
def test_every_section_is_one_loop(first, last, count):
    reader = PhotosReader(pixel_size="1.32mm", thickness="5mm", first=first, last=last)
    contours = trace_stack(HistogramSegmenter().segment(reader.read(FOLDER)))
    assert len(contours) == count
    assert {len(section.loops) for section in contours.sections} == {1}
    codes = {notice.code for notice in contours.notices}
    assert codes <= ({"hole-filled"} if count == 40 else {"hole-filled", "border-contact"})
    areas = np.array([section.loops[0].signed_area for section in contours.sections])
    change = areas[2:] / areas[1:-1]
    assert change.min() > 0.9
    assert change.max() < 1.3


def test_the_thresholds_agree_between_neighbours():
    stack = PhotosReader(pixel_size=1.32, thickness=5, last="1215.jpg").read(FOLDER)
    segmentation = HistogramSegmenter().segment(stack)
    levels = [segmentation.field_of(k, stack.decode(k)).threshold for k in range(len(stack))]
    assert np.abs(np.diff(levels)).max() < 12
