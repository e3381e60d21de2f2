"""Seams follow a real twist, hold round loops still, and say when they cannot know."""

import numpy as np
import pytest

from stackloft.geometry.correspondence import slide_points
from stackloft.geometry.curve_stack import fit_curves
from stackloft.geometry.seams import solve_phases

NONE = np.array([])
NO_CORNERS = np.array([], dtype=np.int64)


def turned(points, degrees):
    a = np.radians(degrees)
    return points @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])


def sampled(loops, corners=None):
    corners = corners or [NO_CORNERS] * len(loops)
    curves = fit_curves(loops, corners)
    section = np.arange(len(loops))[:, None]
    points, slopes = curves.at(section, np.arange(128)[None, :] / 128)
    return curves, points - curves.centroids[:, None, :], slopes


def rounded_rectangle(ratio, count=240):
    t = 2 * np.pi * np.arange(count) / count
    c, s = np.cos(t), np.sin(t)
    return np.stack([ratio * np.sign(c) * abs(c) ** 0.5, np.sign(s) * abs(s) ** 0.5], axis=1) * 10


SQUARE = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * 10


@pytest.mark.parametrize("step", [5.0, 10.0, 20.0, 30.0])
def test_the_twist_of_a_square_bar_is_followed(step):
    loops = [turned(SQUARE, step * k) for k in range(6)]
    curves, points, slopes = sampled(loops, [np.arange(4)] * 6)
    marks = [
        np.mod(curves.knots[curves.first[k] : curves.first[k + 1]] - k - curves.starts[k], 1)
        for k in range(6)
    ]
    seams = solve_phases(points, slopes, marks)
    at_seam, _ = curves.at(np.arange(6), seams.phases)
    angle = np.degrees(np.unwrap(np.angle(at_seam @ [1, 1j])))
    np.testing.assert_allclose(np.diff(angle), step, atol=360 / 128)  # phases are compared on 128 samples
    assert len(seams.tied) == 0


@pytest.mark.parametrize("ratio", [1.05, 1.6])
def test_a_smooth_bar_turned_a_little_raises_no_doubt(ratio):
    loops = [turned(rounded_rectangle(ratio), 10.0 * k) for k in range(6)]
    _, points, slopes = sampled(loops)
    assert len(solve_phases(points, slopes, [NONE] * 6).tied) == 0


def test_a_square_turned_by_half_a_side_is_a_near_tie():
    loops = [turned(SQUARE, 45.0 * k) for k in range(3)]
    _, points, slopes = sampled(loops, [np.arange(4)] * 3)
    assert solve_phases(points, slopes, [NONE] * 3).tied.tolist() == [0, 1]


def test_nearly_circular_loops_do_not_spin():
    rng = np.random.default_rng(5)
    t = 2 * np.pi * np.arange(120) / 120
    loops = []
    for _ in range(20):
        wave = sum(rng.normal(0, 0.01) * np.cos(k * t + rng.uniform(0, 6)) for k in range(2, 7))
        loops.append(((1 + wave) * np.stack([np.cos(t), np.sin(t)])).T * 30)
    _, points, slopes = sampled(loops)
    phases = solve_phases(points, slopes, [NONE] * 20).phases
    assert abs(phases).max() < 0.02


def test_a_quarter_turn_of_an_oval_is_a_near_tie():
    loops = [turned(rounded_rectangle(1.6), 90.0 * k) for k in range(2)]
    _, points, slopes = sampled(loops)
    assert solve_phases(points, slopes, [NONE] * 2).tied.tolist() == [0]


def test_half_turn_symmetry_does_not_flip():
    loops = [turned(rounded_rectangle(2.5), 0.3 * k) for k in range(8)]
    _, points, slopes = sampled(loops)
    assert abs(solve_phases(points, slopes, [NONE] * 8).phases).max() < 0.05


def test_sliding_keeps_order_and_fixed_points():
    t = 2 * np.pi * np.arange(300) / 300
    loops = []
    for depth in np.linspace(0.0, 0.45, 12):
        r = 20 * (1 + depth * np.cos(2 * t))
        loops.append(np.stack([r * np.cos(t), r * np.sin(t)], axis=1))
    curves, _, _ = sampled(loops)
    first = np.tile(np.arange(33) / 33, (12, 1))
    fixed = np.zeros(first.shape, dtype=bool)
    fixed[:, 7] = True
    moved = slide_points(curves, np.linspace(0, 60, 12), first, fixed)
    gaps = np.roll(moved, -1, axis=1) - moved
    gaps[:, -1] += 1
    assert (gaps > 0).all()
    np.testing.assert_allclose(moved[:, 7], first[:, 7], atol=1e-9)
    assert abs(moved - first).max() > 1e-3


def test_coaxial_circles_stay_even():
    t = 2 * np.pi * np.arange(100) / 100
    loops = [r * np.stack([np.cos(t), np.sin(t)], axis=1) for r in (5.0, 20.0, 8.0)]
    curves, _, _ = sampled(loops)
    first = np.tile(np.arange(33) / 33, (3, 1))
    moved = slide_points(curves, np.array([0.0, 4.0, 8.0]), first, np.zeros(first.shape, bool))
    np.testing.assert_allclose(moved, first, atol=1e-6)


def test_one_section_is_returned_as_it_is():
    curves, _, _ = sampled([rounded_rectangle(1.0)])
    first = np.arange(9)[None] / 9
    assert slide_points(curves, np.zeros(1), first, np.zeros((1, 9), bool)) == pytest.approx(first)


@pytest.mark.parametrize("turn", [30.0, 69.0, 76.0])
def test_a_crescent_goes_on_tip_to_tip_though_it_lies_on_the_same_ring(turn):
    t = np.radians(110.0) * np.linspace(-1.0, 1.0, 120)
    half = 6.0 * np.sqrt(1.0 - (t / t[-1]) ** 2)
    sides = [np.stack([r * np.cos(t), r * np.sin(t)], axis=1) for r in (24.0 + half, 24.0 - half)]
    crescent = np.concatenate([sides[0][:-1], sides[1][:0:-1]])
    _, points, slopes = sampled([crescent, turned(crescent, turn)])
    _, straight, _ = sampled([crescent, crescent])
    # Canonical starts turn with the loop or do not: what counts is which points come to lie on which.
    phase = solve_phases(points, slopes, [NONE, NONE]).phases[1]
    met = np.roll(points[1], -round(phase * 128), axis=0)
    assert np.linalg.norm(met - turned(straight[0], turn), axis=1).max() < 3.0
