"""How ends are decided: what is said wins, the height fills in, the areas guess."""

import numpy as np
import pytest

from stackloft.geometry.end_model import distance_to_end, guess_end, local_exponent
from stackloft.model.ends import End, EndKind
from stackloft.model.errors import InputError, UsageError
from stackloft.model.slice_stack import SectionKind
from stackloft.sectioning.ends import StackEnds, plan_ends


def stack(profile, z, kind=SectionKind.FACE, thickness=None):
    z = np.asarray(z, dtype=float)
    return StackEnds(z, np.pi * profile(z) ** 2, kind, thickness)


def ball(z):
    return np.sqrt(100.0 - z**2)


MID = -10 + 20 * (np.arange(10) + 0.5) / 10
AUTO = (End(), End())


def said(text):
    return End.parse_pair(text)


def test_a_balls_poles_are_found_exactly_and_called_a_guess():
    first, last = plan_ends(stack(ball, MID), AUTO, None)
    assert first.kind is last.kind is EndKind.ROUND
    assert (first.length, last.length) == pytest.approx((1.0, 1.0), rel=1e-9)
    assert first.guessed
    assert first.shortest < 1.0 < first.longest


def test_a_double_cones_tips_are_found_by_auto():
    first, last = plan_ends(stack(lambda z: 10 - abs(z), MID), AUTO, None)
    assert first.kind is last.kind is EndKind.POINT
    assert last.length == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("tilt", np.linspace(0.0, 1.2, 7))
def test_an_ellipsoid_in_any_pose_has_its_end_where_the_parabola_says(tilt):
    # areas of parallel sections of any ellipsoid are a parabola in z
    reach = 10 + 10 * np.sin(tilt)
    z = -reach + 2 * reach * (np.arange(11) + 0.5) / 11
    areas = 50.0 * (1 - (z / reach) ** 2)
    found = distance_to_end(areas[::-1], (z[-1] - z)[::-1])
    assert found == pytest.approx(reach / 11, rel=1e-9)


def test_the_height_fixes_the_poles_and_is_no_guess():
    first, last = plan_ends(stack(ball, MID), AUTO, 20.0)
    assert (first.length, last.length) == pytest.approx((1.0, 1.0))
    assert not first.guessed
    assert not last.guessed


def test_the_height_goes_to_the_end_that_is_open():
    first, last = plan_ends(stack(ball, MID), said("face,round"), 20.0)
    assert first.kind is EndKind.FACE
    assert last.length == pytest.approx(2.0)
    first, last = plan_ends(stack(ball, MID), said("round:0.5,point"), 20.0)
    assert (first.length, last.length) == pytest.approx((0.5, 1.5))


def test_a_known_height_tells_flat_from_round_from_pointed():
    bodies = {
        EndKind.FLAT: lambda z: np.full(z.shape, 10.0),
        EndKind.ROUND: ball,
        EndKind.POINT: lambda z: 10 - abs(z),
    }
    for kind, profile in bodies.items():
        assert plan_ends(stack(profile, MID), AUTO, 20.0)[1].kind is kind


def test_a_cut_body_is_rounded_but_perhaps_a_face():
    z = MID[2:-2]
    first, _ = plan_ends(stack(ball, z), AUTO, None)
    assert first.kind is EndKind.ROUND
    assert first.perhaps_face
    assert [end.kind for end in first.extremes] == [EndKind.FACE, EndKind.ROUND]


def test_an_end_is_never_further_than_one_pitch():
    guess = guess_end(np.array([99.0, 100.0, 100.5]), np.array([0.0, 5.0, 10.0]), 5.0)
    assert guess.length <= 5.0
    growing = guess_end(np.array([120.0, 110.0, 100.0]), np.array([0.0, 5.0, 10.0]), 5.0)
    assert growing.length == pytest.approx(2.5)
    assert "do not close" in growing.reason


def test_flat_without_a_length():
    with pytest.raises(UsageError, match="flat:LEN"):
        plan_ends(stack(ball, MID), said("flat"), None)
    slab = stack(ball, MID, SectionKind.SLAB, 1.5)
    assert plan_ends(slab, said("flat"), None)[0].length == pytest.approx(0.75)
    assert plan_ends(stack(ball, MID), said("flat"), 20.0)[0].kind is EndKind.FLAT


@pytest.mark.parametrize("height", [17.0, 18.0])
def test_a_height_within_the_sections_is_refused(height):
    with pytest.raises(InputError, match="--height"):
        plan_ends(stack(ball, MID), AUTO, height)


def test_a_height_against_given_ends_is_refused():
    with pytest.raises(InputError, match="contradicts"):
        plan_ends(stack(ball, MID), said("face"), 25.0)
    plan_ends(stack(ball, MID), said("face"), 18.0)


@pytest.mark.parametrize("q", [0.5, 1.0, 1.5, 2.0])
def test_the_exponent_is_read_off_two_sections(q):
    depth = np.array([0.0, 2.0])
    assert local_exponent((depth + 1.0) ** q, depth, 1.0) == pytest.approx(q)


def test_two_sections_are_enough():
    first, _ = plan_ends(stack(ball, [-3.0, 5.0]), AUTO, None)
    assert 0 < first.length <= 8.0


@pytest.mark.parametrize("text", ["blunt", "face:3mm", "auto:1", "round:0", "flat:-2mm", "round:x", ""])
def test_bad_ends_are_refused(text):
    with pytest.raises(UsageError):
        End.parse_pair(text)


@pytest.mark.parametrize("rounding", [-1e-13, 0.0, 1e-13])
def test_a_cut_cone_closes_at_its_apex_whichever_way_the_rounding_goes(rounding):
    depth = np.array([0.0, 2.0, 4.0])
    areas = (10.0 + depth) ** 2 * [1.0, 1.0 + rounding, 1.0]
    assert distance_to_end(areas, depth) == pytest.approx(10.0, rel=1e-5)
