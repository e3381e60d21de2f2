"""Whichever of a body's four mirrored poses was given, it is lofted in the same one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from stackloft.geometry.end_model import distance_to_end
from stackloft.geometry.odd_moments import central_moment_ratios
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.sectioning.canonical_pose import FLIPS, POWERS, canonical_flip, flipped_stack
from stackloft.sectioning.corner_columns import follow_corners
from stackloft.sectioning.dense_loops import even_polygon
from stackloft.sectioning.loop_curves import ready_curves, ready_loops
from stackloft.testing import phantoms


def scaled(stack, flip):
    sections = tuple(
        replace(s, loops=tuple(replace(loop, points=loop.points * flip) for loop in s.loops))
        for s in stack.sections
    )
    return ContourStack(sections)


def place(loops):
    """Return a loop's points in an order that says nothing."""
    points = np.concatenate([loop.points for loop in loops])
    return points[np.lexsort(points.round(9).T)]


@pytest.mark.parametrize("name", ["potato", "meat", "y-branch"])
def test_all_four_poses_are_laid_the_same_way(name):
    stack = phantoms.make(name).contour_stack(7)
    laid = []
    for flip in FLIPS:
        given = scaled(stack, flip)
        laid.append(flipped_stack(given, canonical_flip(given)))
    for other in laid[1:]:
        for one, two in zip(laid[0].sections, other.sections, strict=True):
            np.testing.assert_array_equal(place(one.loops), place(two.loops))


def test_what_is_laid_already_stays():
    stack = phantoms.make("potato").contour_stack(7)
    laid = flipped_stack(stack, canonical_flip(stack))
    assert canonical_flip(laid) == (1.0, 1.0)
    assert flipped_stack(laid, (1.0, 1.0)) is laid


def test_a_symmetric_body_is_left_as_it_is():
    t = 2 * np.pi * np.arange(64) / 64
    loop = Loop(np.column_stack([3 * np.cos(t), 2 * np.sin(t)]) + [40.0, -7.0])
    stack = ContourStack(tuple(Section(float(k), (loop,), str(k)) for k in range(4)))
    assert canonical_flip(stack) == (1.0, 1.0)


def test_a_body_that_only_leans_is_told_by_the_way_it_leans():
    """Its sections are symmetric, and it is the same turned over: only x·z tells left from right."""
    t = 2 * np.pi * np.arange(64) / 64
    circle = np.column_stack([np.cos(t), np.sin(t)])
    leaning, other = (
        ContourStack(tuple(Section(float(k), (Loop(circle + [lean * k, 0.0]),), str(k)) for k in range(5)))
        for lean in (0.5, -0.5)
    )
    assert canonical_flip(leaning) == (1.0, 1.0)
    assert canonical_flip(other) == (-1.0, 1.0)


@pytest.mark.parametrize("flip", FLIPS)
def test_curves_flipped_are_the_curves_of_flipped_loops(flip):
    stack = phantoms.make("prism").contour_stack(4, "faces")  # with corners
    known = flipped_stack(stack, flip)
    fresh = scaled(stack, flip)
    for one, two in zip(ready_loops(known), ready_loops(fresh), strict=True):
        np.testing.assert_allclose(place(one), place(two), atol=1e-12)
    here, there = ready_curves(known), ready_curves(fresh)
    s = 0.0017 + np.arange(97) / 97  # not at a corner, where slopes jump
    for k in range(len(here)):
        for a, b in zip(here.at(np.full(97, k), s), there.at(np.full(97, k), s), strict=True):
            np.testing.assert_allclose(a, b, atol=1e-9 * here.lengths[k])


@pytest.mark.parametrize("powers", POWERS)
def test_odd_moments_change_their_sign_in_the_mirror(powers):
    rng = np.random.default_rng(3)
    loops = [rng.normal(size=(3, 2)) * 5 + 20 for _ in range(4)]
    z, weights = np.array([0.0, 1.0, 2.5, 4.0]), np.array([1.0, 1.2, 1.5, 1.5])
    (value,) = central_moment_ratios(loops, z, weights, [powers])
    for flip in FLIPS:
        sign = flip[0] ** powers[0] * flip[1] ** powers[1]
        mirrored = [np.roll(p, 1, axis=0) * flip for p in loops]
        assert central_moment_ratios(mirrored, z, weights, [powers])[0] == pytest.approx(sign * value)


def test_even_polygons_do_not_feel_where_the_vertices_lie():
    t = 2 * np.pi * np.arange(200) / 200
    polygons = []
    for start in (0.0, 0.013, -0.013):
        circle = np.column_stack([3 * np.cos(t + start), 2 * np.sin(t + start)])
        stack = ContourStack(tuple(Section(float(k), (Loop(circle),), str(k)) for k in range(2)))
        polygons.append(even_polygon(ready_curves(stack), 0, np.array([], dtype=int), 160))
    np.testing.assert_allclose(polygons[1], polygons[0], atol=1e-7)
    np.testing.assert_allclose(polygons[2], polygons[0], atol=1e-7)


def test_areas_equal_but_for_rounding_do_not_close():
    depth = np.array([0.0, 4.0])
    for wobble in (0.0, 1e-14, -1e-14):
        assert distance_to_end(np.array([77.0, 77.0 + wobble]), depth) is None


def test_corners_at_both_ends_of_a_tube_are_one_column():
    """Of the pins of two joints, one above the other, neither gives way."""
    none = np.empty(0)
    for wobble in (0.0, 1e-13, -1e-13):
        marks = [np.array([0.25, 0.75]), none, none, np.array([0.25 + wobble, 0.75 + wobble])]
        chains = follow_corners(marks, 33, frozenset({0, 3}))
        assert [sorted(chain.at) for chain in chains] == [[0, 3], [0, 3]]


def test_corners_on_both_sides_of_the_seam_are_one_column():
    none = np.empty(0)
    (chain,) = follow_corners([np.array([0.995]), none, np.array([0.004])], 33, frozenset({0, 2}))
    assert chain.at[0] - chain.at[2] == pytest.approx(-0.009)
