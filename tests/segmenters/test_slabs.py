"""One level for a whole scan: half-full voxels lie on the boundary, whatever the slices show."""

import numpy as np
import pytest

from stackloft.model.errors import InputError
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.sectioning.contour_sink import trace_stack
from stackloft.testing import phantoms
from stackloft_plugins.segmenters.histogram import HistogramSegmenter


def stack_of(volume):
    slices, grid = volume.slices, volume.grid
    return SliceStack(
        lambda k: slices[k],
        tuple(f"s{k}" for k in range(len(slices))),
        grid.shape,
        grid.positions,
        np.tile(grid.spacing, (len(slices), 1)),
        SectionKind.SLAB,
        thickness=np.full(len(slices), grid.thickness),
    )


@pytest.fixture(scope="module")
def ball():
    return phantoms.make("ellipsoid", a=24, b=19, c=30, rotation=3, offset=(3.1, -2.7, 11.9))


@pytest.fixture(scope="module")
def clean(ball):
    return stack_of(phantoms.Scans(sections=12, pixel_size=1.0, empty=2).volume(ball))


def test_the_level_is_half_way_between_air_and_body(clean):
    for extra in ({}, {"channel": "red"}):
        segmentation = HistogramSegmenter(**extra).segment(clean)
        thresholds = {segmentation.field_of(k, segmentation.stack.decode(k)).threshold for k in range(12)}
        assert thresholds == {-480.0}


def test_empty_slices_at_either_end_are_left_out(clean):
    segmentation = HistogramSegmenter().segment(clean)
    assert len(clean) == 16
    assert 10 <= len(segmentation) <= 12
    assert len(trace_stack(segmentation)) == len(segmentation)


def test_the_areas_are_those_of_the_sections(ball, clean):
    contours = trace_stack(HistogramSegmenter().segment(clean))
    inner = contours.sections[3:-3]
    for section in inner:
        true = sum(loop.signed_area for loop in ball.section(section.z))
        assert section.loops[0].signed_area == pytest.approx(true, rel=0.006)


def test_noise_and_bias_hardly_move_the_level(ball):
    scanner = phantoms.Scans(sections=12, pixel_size=1.0, levels=(30.0, 800.0), noise=30.0, bias=0.1)
    segmentation = HistogramSegmenter().segment(stack_of(scanner.volume(ball)))
    level = segmentation.field_of(3, segmentation.stack.decode(3)).threshold
    assert level == pytest.approx(0.5 * (50 + 760), abs=40)


def test_a_dark_body_in_a_light_surrounding(ball):
    light = stack_of(phantoms.Scans(sections=12, pixel_size=1.0, levels=(900.0, 100.0)).volume(ball))
    segmentation = HistogramSegmenter().segment(light)
    field = segmentation.field_of(4, segmentation.stack.decode(4))
    assert field.threshold == 500.0
    assert field.level == -500.0


def test_a_window_of_grey_levels(clean):
    by_window = trace_stack(HistogramSegmenter(window=(-480.0, 3000.0)).segment(clean))
    by_level = trace_stack(HistogramSegmenter(threshold=-480.0).segment(clean))
    for a, b in zip(by_window.sections, by_level.sections, strict=True):
        assert a.loops[0].signed_area == pytest.approx(b.loops[0].signed_area, rel=2e-3)


def test_a_blank_scan_is_refused(clean):
    blank = np.zeros(clean.shape, dtype=np.int16)
    stack = SliceStack(
        lambda k: blank, ("a", "b"), clean.shape, np.arange(2.0), np.ones((2, 2)), SectionKind.SLAB
    )
    with pytest.raises(InputError, match="blank"):
        HistogramSegmenter().segment(stack)
