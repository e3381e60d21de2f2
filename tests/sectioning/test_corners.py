"""Corners are found where they are and nowhere else."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter, median_filter

from stackloft.model.contour_stack import Loop
from stackloft.model.segmentation import SectionField
from stackloft.sectioning.corners import polygon_corners
from stackloft.sectioning.nesting import nesting_depths
from stackloft.sectioning.traced_corners import with_corners
from stackloft.sectioning.tracing import trace_field
from stackloft.testing.phantoms.coverage import coverage


def ellipse_points(count, ratio=1.0, phase=0.0, radius=20.0):
    t = phase + 2 * np.pi * np.arange(count) / count
    return np.column_stack([ratio * radius * np.cos(t), radius * np.sin(t)])


def polygon(corners, per_side=1):
    corners = np.asarray(corners, dtype=float)
    steps = np.arange(per_side)[:, None] / per_side
    return np.concatenate(
        [a + (b - a) * steps for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    )


BOX = [(0, 0), (30, 0), (30, 20), (0, 20)]


@pytest.mark.parametrize("per_side", [1, 2, 5, 100])
def test_a_box_has_four_however_dense(per_side):
    assert polygon_corners(polygon(BOX, per_side)).tolist() == [k * per_side for k in range(4)]


@pytest.mark.parametrize("sides", [3, 4, 5, 6])
def test_prisms_have_all(sides):
    assert len(polygon_corners(ellipse_points(sides))) == sides
    assert len(polygon_corners(polygon(ellipse_points(sides), 20))) == sides


@given(count=st.sampled_from([12, 33, 100, 400]), ratio=st.floats(1, 3), phase=st.floats(0, 1))
def test_ellipses_have_none(count, ratio, phase):
    assert not len(polygon_corners(ellipse_points(count, ratio, phase)))


@given(ratio=st.floats(3, 6), phase=st.floats(0, 1))
def test_slender_ellipses_of_33_points_have_none(ratio, phase):
    assert not len(polygon_corners(ellipse_points(33, ratio, phase)))


def test_a_half_disc_has_two():
    arc = np.linspace(0, np.pi, 30)
    points = np.concatenate(
        [np.column_stack([np.cos(arc), np.sin(arc)]), polygon([(-1, 0), (1, 0)], 10)[1:10]]
    )
    assert polygon_corners(points).tolist() == [0, 29]


def test_the_steps_of_a_pixel_outline_are_no_corners():
    steps = np.repeat(np.arange(20.0), 2)
    stair = np.column_stack([steps[:-1], steps[1:]])
    assert not len(polygon_corners(np.concatenate([stair, [(19.0, 19.0), (25.0, -5.0)]])))


def test_nesting_is_even_odd():
    square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    assert nesting_depths([3 * square, square, 2 * square, square + 9]) == [0, 2, 1, 0]


CENTRE = np.array([60.37, 59.81])


def photographed(outline, blur=0.0, noise=0.0, seed=0, shape=(120, 121)):
    """Trace an outline (pixels) as the histogram segmenter would: 3×3 median, half-way level."""
    levels = gaussian_filter(130 * coverage([outline + 0.5], shape), blur)
    levels = np.rint(levels + np.random.default_rng(seed).normal(0, noise, shape) if noise else levels)
    return trace_field(SectionField(median_filter(levels, 3), 65.0), (1.0, 1.0), shape, "a").loops[0]


def turned(points, degrees):
    turn = np.radians(degrees)
    return points @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])


SQUARE = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])


@pytest.mark.parametrize("blur", [0.0, 0.7])
@pytest.mark.parametrize("degrees", [0, 5, 12.5, 22.5, 30, 38, 45])
def test_a_20_mm_square_at_0_3_mm(degrees, blur):
    half = 10 / 0.3
    loop = with_corners(photographed(turned(half * SQUARE, degrees) + CENTRE, blur), 1.0)
    found = turned(loop.points[loop.corners] - CENTRE, -degrees)
    assert np.sort(np.arctan2(*found.T)) == pytest.approx(np.radians([-135, -45, 45, 135]), abs=0.01)
    assert np.abs(np.abs(found) - half).max() < (0.15 if blur else 0.03)
    assert loop.signed_area == pytest.approx(4 * half**2, rel=3e-4)


@pytest.mark.parametrize("seed", range(12))
def test_corners_survive_noise(seed):
    outline = turned(10 / 0.3 * SQUARE, 7.3 * seed) + CENTRE
    assert len(with_corners(photographed(outline, 0.7, 5.0, seed), 1.0).corners) == 4


@pytest.mark.parametrize("seed", range(40))
def test_smooth_outlines_have_none_with_noise(seed):
    rng = np.random.default_rng(seed)
    radius, ratio = rng.uniform(10, 50), rng.uniform(0.3, 1)
    outline = turned(ellipse_points(2000, 1.0, 0.0, radius) * [1, ratio], rng.uniform(0, 180))
    waves = np.arange(2, 6)
    t = np.arctan2(outline[:, 1], outline[:, 0])
    bumps = (0.04 / waves * rng.normal(size=4)) @ np.cos(waves[:, None] * t + rng.uniform(0, 6, (4, 1)))
    loop = photographed(outline * (1 + bumps)[:, None] + CENTRE, 0.7, 4.0, seed)
    assert not len(with_corners(loop, 1.0).corners)


def test_sharp_tips_of_slender_ellipses_are_smooth():
    for ratio in (0.2, 0.25, 0.3, 0.4):
        loop = photographed(ellipse_points(4000, 1.0, 0.0, 50) * [1, ratio] + CENTRE)
        assert not len(with_corners(loop, 1.0).corners)


def test_pixel_size_and_holes():
    loop = photographed(10 / 0.3 * SQUARE + CENTRE)
    small = with_corners(Loop(0.3 * loop.points[::-1], hole=True), 0.3)
    assert small.hole
    assert len(small.corners) == 4
    assert small.signed_area == pytest.approx(-400, rel=1e-3)
