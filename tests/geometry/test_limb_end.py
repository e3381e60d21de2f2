"""An even limb's round cap is found from the one section in it, and nothing else is taken for a limb."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stackloft.geometry.limb_end import distance_to_limb_end


def bar(radius, first, pitch, count=6):
    """Return areas, half widths and depths of a bar with a half-ball on it, cut `first` mm below its top."""
    depth = first + pitch * np.arange(count)
    r = np.sqrt(radius**2 - np.maximum(radius - depth, 0.0) ** 2)
    return np.pi * r**2, r, depth - depth[0]


@given(st.floats(1.0, 50.0), st.floats(0.05, 0.95), st.floats(0.0, 1.0))
@settings(max_examples=200, deadline=None)
def test_a_round_cap_is_found_exactly_when_one_section_lies_in_it(radius, first, room):
    pitch = radius * (1.0 - first) * (1.0 + room) + 1e-3 * radius  # the next section is below the cap
    areas, widths, depth = bar(radius, first * radius, pitch)
    found = distance_to_limb_end(areas, widths, depth)
    if areas[0] >= 0.99 * areas[1]:
        assert found is None  # the cap has hardly begun: areas that are all alike do not close
    else:
        assert found == pytest.approx(first * radius, rel=1e-9)


@pytest.mark.parametrize("first", [0.01, 0.1, 0.25])
def test_two_sections_in_the_cap_will_do_as_well(first):
    areas, widths, depth = bar(10.0, first * 10.0, 6.0)
    assert areas[1] < areas[2] == areas[3]
    assert distance_to_limb_end(areas, widths, depth) == pytest.approx(first * 10.0, rel=1e-9)


@given(st.integers(4, 40), st.floats(0.05, 1.0), st.floats(0.2, 5.0))
@settings(max_examples=200, deadline=None)
def test_no_ellipsoid_is_a_limb(count, first, stretch):
    z = -1.0 + 2.0 * (np.arange(count) + first) / count
    areas = np.pi * np.maximum(1.0 - z**2, 1e-9)
    assert distance_to_limb_end(areas, np.sqrt(areas / np.pi) * stretch, z - z[0]) is None


@pytest.mark.parametrize("scale", [1e-3, 7.0, 1e4])
def test_millimetres_or_metres_make_no_difference(scale):
    areas, widths, depth = bar(6.0, 2.0, 8.0)
    assert distance_to_limb_end(scale**2 * areas, scale * widths, scale * depth) == pytest.approx(2.0 * scale)


def test_a_cap_blunter_than_a_ball_ends_before_the_next_section_but_one():
    """A wide plug with rounded edges: a ball as wide would still be closing where it is even already."""
    areas, widths = np.pi * np.array([90.0, 100.0, 100.0, 100.0]) ** 2, np.array([90.0, 100.0, 100.0, 100.0])
    depth = 5.0 * np.arange(4)
    found = distance_to_limb_end(areas, widths, depth)
    height = 5.0 / np.sqrt(1.0 - 0.81)
    assert found == pytest.approx(height - 5.0)


@pytest.mark.parametrize(
    "areas", [[1.0, 2.0, 2.0], [1.0, 2.0, 2.0, 1.5], [2.0, 2.0, 2.0, 2.0], [1.0, 1.5, 2.0, 2.5, 3.0]]
)
def test_too_few_sections_an_equator_a_prism_and_a_cone_are_none(areas):
    areas = np.array(areas)
    assert distance_to_limb_end(areas, np.sqrt(areas), np.arange(len(areas)) * 1.0) is None
