"""Cubic splines: exact on cubics, fourth order elsewhere, blind to where a loop starts."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicSpline

from stackloft.geometry.arc_splines import spline_tangents
from stackloft.geometry.cubic_operators import broken_periodic_tangents, open_tangents, periodic_tangents
from stackloft.geometry.curve_stack import fit_curves

NO_CORNERS = np.array([], dtype=np.int64)


def ellipse(a, b, count, start=0.0):
    t = start + 2 * np.pi * np.arange(count) / count
    return np.stack([a * np.cos(t), b * np.sin(t)], axis=1)


@given(st.lists(st.integers(2, 9), min_size=1, max_size=6), st.integers(0, 2**32 - 1))
@settings(max_examples=60, deadline=None)
def test_tangents_of_many_arcs_are_those_of_each_arc_alone(sizes, seed):
    rng = np.random.default_rng(seed)
    arcs = [(np.cumsum(rng.uniform(0.3, 1, n)), rng.normal(size=(n, 2))) for n in sizes]
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    together = spline_tangents(
        np.concatenate([t for t, _ in arcs]), np.concatenate([p for _, p in arcs]), starts
    )
    for first, (t, p) in zip(starts, arcs, strict=True):
        alone = together[first : first + len(t)]
        if len(t) < 5:
            exact = [Polynomial.fit(t, axis, len(t) - 1).deriv()(t) for axis in p.T]
            np.testing.assert_allclose(alone, np.stack(exact, axis=1), atol=1e-8)
        else:
            peer = CubicSpline(t, p, bc_type=((1, alone[0]), (1, alone[-1])))
            np.testing.assert_allclose(alone, peer(t, 1), atol=1e-9)


@given(st.lists(st.floats(0.2, 2.0), min_size=4, max_size=12))
def test_open_tangents_are_exact_on_cubics(steps):
    t = np.concatenate([[0.0], np.cumsum(steps)])
    cubic = Polynomial([1.0, -2.0, 0.5, 0.25])
    found = open_tangents(t) @ np.append(cubic(t), [0.0, 0.0])
    np.testing.assert_allclose(found, cubic.deriv()(t), rtol=1e-9, atol=1e-9)


def test_given_end_tangents_are_taken():
    t = np.array([0.0, 1.0, 2.5, 3.0])
    found = open_tangents(t, (True, True)) @ np.array([0.0, 1.0, 0.0, 2.0, 7.0, -3.0])
    assert found[0] == pytest.approx(7.0)
    assert found[-1] == pytest.approx(-3.0)


def test_periodic_tangents_converge_with_fourth_order():
    errors = []
    for n in (16, 32, 64):
        t = 2 * np.pi * np.arange(n) / n
        slope = periodic_tangents(np.full(n, t[1])) @ np.exp(np.sin(t))
        errors.append(abs(slope - np.cos(t) * np.exp(np.sin(t))).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 3.7).all()


def test_a_break_keeps_a_square_straight():
    side = np.linspace(0.0, 1.0, 5)[:-1]
    x = np.concatenate([side, np.ones(4), 1 - side, np.zeros(4)])
    corners = np.zeros(16, dtype=bool)
    corners[[0, 4, 8, 12]] = True
    arriving, leaving = broken_periodic_tangents(np.ones(16), corners)
    np.testing.assert_allclose(leaving @ x, np.repeat([0.25, 0.0, -0.25, 0.0], 4), atol=1e-13)
    np.testing.assert_allclose(arriving @ x, np.roll(leaving @ x, 1), atol=1e-13)


@given(st.integers(0, 199), st.floats(0.3, 3.0))
@settings(max_examples=30, deadline=None)
def test_a_curve_does_not_depend_on_the_vertex_it_starts_from(shift, ratio):
    loop = ellipse(10.0, 10.0 * ratio, 200) + [3.0, -40.0]
    one, other = (fit_curves([p], [NO_CORNERS]) for p in (loop, np.roll(loop, shift, axis=0)))
    s = np.linspace(0.0, 1.0, 33, endpoint=False)
    section = np.zeros(33, dtype=np.int64)
    np.testing.assert_allclose(one.at(section, s)[0], other.at(section, s)[0], atol=1e-10)
    assert one.areas[0] == pytest.approx(other.areas[0], rel=1e-13)


def test_area_and_perimeter_of_a_circle_converge_with_fourth_order():
    errors = []
    for n in (16, 32, 64):
        curves = fit_curves([ellipse(1.0, 1.0, n)], [NO_CORNERS])
        errors.append([abs(curves.areas[0] - np.pi), abs(curves.lengths[0] - 2 * np.pi)])
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert (orders > 3.8).all()


def test_a_polygon_with_corners_is_exact():
    box = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]]) + [100.0, -7.0]
    curves = fit_curves([box], [np.arange(4)])
    assert curves.areas[0] == pytest.approx(4.0, rel=1e-13)
    assert curves.lengths[0] == pytest.approx(10.0, rel=1e-14)
    np.testing.assert_allclose(curves.centroids[0], [102.0, -6.5], rtol=1e-13)


def test_sections_do_not_leak_into_each_other_at_the_wrap():
    loops = [ellipse(10.0, 8.0, 40), ellipse(10.0, 8.0, 40) + [500.0, 0.0]]
    curves = fit_curves(loops, [NO_CORNERS, NO_CORNERS])
    tiny = np.array([-1e-17, 0.0, 1.0 - 1e-16, 1.0])
    points, _ = curves.at(np.zeros(4, dtype=np.int64), tiny)
    assert (points[:, 0] < 20.0).all()
