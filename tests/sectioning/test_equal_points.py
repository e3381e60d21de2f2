"""Equal points: corners kept, order kept, start and file order of no matter."""

import numpy as np
import pytest

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.sectioning.corner_columns import follow_corners, places_of, share_points
from stackloft.sectioning.equal_points import equal_points
from stackloft.sectioning.smoothing import smooth_loop

BOX = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 10.0], [0.0, 10.0]])


def circle(radius, count=100):
    t = 2 * np.pi * np.arange(count) / count
    return radius * np.stack([np.cos(t), np.sin(t)], axis=1)


def stack(*loops):
    return ContourStack(
        tuple(
            Section(5.0 * k, (loop,) if isinstance(loop, Loop) else loop, f"s{k}")
            for k, loop in enumerate(loops)
        )
    )


@pytest.mark.parametrize("count", [8, 33, 100, 400])
def test_corners_are_among_the_points(count):
    found = equal_points(stack(Loop(BOX, np.arange(4)), Loop(BOX + 1.0, np.arange(4))), count)
    assert found.points.shape == (2, count, 3)
    assert found.corners.sum(axis=1).tolist() == [4, 4]
    for section, shift in zip((0, 1), (0.0, 1.0), strict=True):
        corners = found.points[section, found.corners[section], :2]
        assert {tuple(p) for p in corners.round(9)} == {tuple(p) for p in (BOX + shift)}


@pytest.mark.parametrize("count", [5, 33, 64, 65, 400])
def test_points_lie_on_the_loop_in_order(count):
    found = equal_points(stack(*(Loop(circle(r)) for r in (8.0, 10.0, 9.0))), count)
    radius = np.hypot(found.points[..., 0], found.points[..., 1])
    np.testing.assert_allclose(radius, np.broadcast_to([[8.0], [10.0], [9.0]], radius.shape), rtol=1e-6)
    angle = np.unwrap(np.arctan2(found.points[..., 1], found.points[..., 0]), axis=1)
    assert (np.diff(angle, axis=1) > 0).all()


def test_clockwise_loops_and_repeated_points_are_put_right():
    plain = equal_points(stack(Loop(circle(8.0)), Loop(circle(9.0))), 33)
    odd = np.repeat(circle(8.0)[::-1], 2, axis=0)
    other = equal_points(stack(Loop(odd), Loop(circle(9.0))), 33)
    np.testing.assert_allclose(other.points, plain.points, atol=1e-9)


def test_a_closed_polygon_with_its_first_corner_repeated_keeps_its_corners():
    loop = Loop(np.concatenate([BOX, BOX[:1]]), np.array([0, 1, 2, 3]))
    found = equal_points(stack(loop, Loop(BOX, np.arange(4))), 33)
    assert found.corners.sum(axis=1).tolist() == [4, 4]


def test_a_corner_on_one_section_of_many_is_noise():
    sections = [Loop(circle(10.0)) for _ in range(5)]
    sections[2] = Loop(circle(10.0), np.array([17]))
    assert not equal_points(stack(*sections), 33).corners.any()


@pytest.mark.parametrize(
    ("loops", "message"),
    [
        ((Loop(circle(9)),), "at least 2 sections"),
        ((Loop(circle(9)), ()), "no loop"),
        ((Loop(circle(9)), (Loop(circle(9)), Loop(circle(3), hole=True))), "1 holes"),
        ((Loop(circle(9)), (Loop(circle(9)), Loop(circle(3) + 30))), "2 outer loops"),
        ((Loop(circle(9)), Loop(np.zeros((5, 2)))), "without area"),
        ((Loop(circle(9)), Loop(np.linspace(0, 1, 10)[:, None] * [1.0, 2.0])), "without area"),
    ],
)
def test_what_cannot_be_lofted_is_refused_by_name(loops, message):
    with pytest.raises(InputError, match=message):
        equal_points(stack(*loops), 33)


def test_chains_are_followed_through_drift_and_do_not_cross():
    corners = [np.array([0.1 + 0.02 * k, 0.6 + 0.03 * k]) % 1.0 for k in range(10)]
    chains = follow_corners(corners, 20)
    assert [len(chain.at) for chain in chains] == [10, 10]


def test_short_chains_that_would_meet_elsewhere_are_dropped():
    rng = np.random.default_rng(7)
    for _ in range(50):
        corners = [np.sort(rng.uniform(0, 1, rng.integers(0, 5))) for _ in range(12)]
        chains = follow_corners(corners, 33)
        for section in range(12):
            places = np.array([float(places_of(chain, section)) for chain in chains])
            gaps = np.mod(np.roll(places, -1) - places, 1.0)
            assert len(chains) < 2 or (gaps.min() > 0.3 / 33 and gaps.sum() == pytest.approx(1.0))


@pytest.mark.parametrize("count", [4, 5, 9, 33, 400])
def test_shares_add_up_and_nobody_goes_without(count):
    chains = follow_corners([np.array([0.0, 0.02, 0.5, 0.9])] * 3, 33)
    shares = share_points(chains, count)
    assert sum(shares) == count
    assert min(shares) >= 1


@pytest.mark.parametrize("radius", [20.0, 100.0])
def test_smoothing_neither_shrinks_nor_ripples(radius):
    rng = np.random.default_rng(3)
    exact = circle(radius, int(7 * radius))
    noisy = Loop(exact + rng.normal(0.0, 0.05, exact.shape))
    found = smooth_loop(noisy, 1.0).points
    distance = np.linalg.norm(found, axis=1) - radius
    assert abs(distance.mean()) < 0.01
    assert distance.std() < 0.035


def test_smoothing_keeps_corners():
    side = np.linspace(0.0, 60.0, 61)[:-1]
    edges = ((side, 0 * side), (0 * side + 60, side), (60 - side, 0 * side + 60), (0 * side, 60 - side))
    square = np.concatenate([np.stack(edge, axis=1) for edge in edges])
    found = smooth_loop(Loop(square, np.array([0, 60, 120, 180])), 1.0)
    assert abs(found.signed_area) == pytest.approx(3600.0, rel=1e-9)
    assert len(found.corners) == 4
