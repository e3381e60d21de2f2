"""How figures settle: the sample meat shows the paper's finding; a stack is decoded once."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import stackloft
from stackloft.model.errors import InputError, UsageError
from stackloft.studies.bisection import bisection_order, section_counts
from stackloft.studies.convergence import POINTS
from stackloft.testing import phantoms

SAMPLES = Path(__file__).parents[2] / "sample_stacks"


@pytest.fixture(scope="module")
def meat():
    return stackloft.convergence(SAMPLES / "meat")


def worst(rows, name, least):
    errors = [(row.volume_error, row.area_error) for row in rows if getattr(row, name) >= least]
    return np.abs(errors).max()


def test_the_sample_meat_settles_as_the_paper_s_did(meat):
    """Goñi, Purlis & Salvadori (2007): asymptotic, under 1 % past 33 points and past 7 sections."""
    assert worst(meat.by_points, "points", 33) < 0.01
    assert worst(meat.by_sections, "sections", 7) < 0.1
    envelope = [worst(meat.by_points, "points", least) for least in (5, 9, 17, 33, 65, 181)]
    assert all(later < 0.8 * earlier for earlier, later in pairwise(envelope))
    envelope = [worst(meat.by_sections, "sections", least) for least in (2, 3, 4, 5)]
    assert all(later < 0.8 * earlier for earlier, later in pairwise(envelope))


def test_its_whole_model_is_what_measure_gives_with_as_many_points(meat):
    whole = stackloft.measure(SAMPLES / "meat", points=400).objects[0]
    assert meat.reference.volume == pytest.approx(whole.volume.value, rel=1e-12)
    assert meat.reference.area == pytest.approx(whole.area.value, rel=1e-12)
    assert meat.by_points[-1] == meat.by_sections[-1] == meat.reference
    assert (meat.reference.sections, meat.reference.volume_error) == (11, 0.0)


def test_its_counts_are_those_asked_for(meat):
    assert tuple(row.points for row in meat.by_points) == POINTS
    assert (POINTS[0], POINTS[-1]) == (5, 400)
    assert tuple(row.sections for row in meat.by_sections) == tuple(range(2, 12))


def test_what_suffices_is_the_least_from_which_on_all_are_within(meat):
    for tolerance in (0.01, 0.1, 1.0, 5.0):
        points, sections = meat.suffices(tolerance)
        for rows, name, least in (
            (meat.by_points, "points", points),
            (meat.by_sections, "sections", sections),
        ):
            if least is None:
                assert not rows[-2].within(tolerance)
                continue
            assert worst(rows, name, least) <= tolerance
            below = [row for row in rows if getattr(row, name) < least]
            assert not below or not below[-1].within(tolerance)


def test_each_slice_is_decoded_once():
    stack = stackloft.read(SAMPLES / "meat")
    decoded = []

    def decode(k):
        decoded.append(k)
        return stack.decode(k)

    counted = stackloft.SliceStack(
        decode, stack.names, stack.shape, stack.positions, stack.pixel_spacing, stack.kind, hints=stack.hints
    )
    stackloft.convergence(counted)
    assert sorted(decoded) == list(range(11))


def test_contours_show_their_order():
    stack = phantoms.make("potato", seed=3).contour_stack(sections=17)
    found = stackloft.convergence(stack, height=phantoms.make("potato", seed=3).height)
    assert worst(found.by_points, "points", 33) < 0.1
    assert worst(found.by_sections, "sections", 13) < 0.2
    assert found.reference.failure is None


def test_a_method_without_points_is_studied_by_sections_alone():
    found = stackloft.convergence(
        phantoms.make("ellipsoid").contour_stack(sections=9, points=60), "cavalieri"
    )
    assert found.by_points == ()
    assert found.reference.points is None
    assert found.reference.area is None
    assert found.suffices(50.0)[0] is None
    assert len(found.by_sections) == 8


def test_a_model_that_cannot_be_made_is_a_row_with_its_reason():
    found = stackloft.convergence(
        phantoms.make("prism").contour_stack(sections=5, placing="faces"), ends="face"
    )
    few = [row for row in found.by_points if row.failure]
    assert [row.points for row in few] == [5]  # too few for four corners: the loft contradicts its sections
    assert "disagree" in few[0].failure
    assert found.by_sections[0].volume_error == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    ("source", "method", "error", "words"),
    [
        ("no-such-folder", "loft", InputError, "no such file"),
        (SAMPLES / "meat", "loft,frustum", UsageError, "one method"),
        (SAMPLES / "meat", "no-such-method", stackloft.PluginError, "no-such-method"),
    ],
)
def test_refusals(source, method, error, words):
    with pytest.raises(error, match=words):
        stackloft.convergence(source, method)


@pytest.mark.parametrize("m", [2, 3, 4, 7, 11, 33, 34, 80, 257])
def test_bisection_is_nested_keeps_the_ends_and_halves_the_widest_gap(m):
    rng = np.random.default_rng(m)
    z = np.cumsum(rng.uniform(0.5, 2.0, m))
    order = bisection_order(z)
    assert set(order[:2]) == {0, m - 1}
    assert sorted(order) == list(range(m))
    counts = section_counts(m)
    assert (counts[0], counts[-1]) == (2, m)
    assert (np.diff(counts) > 0).all()
    widest = [np.diff(z[sorted(order[:count])]).max() for count in range(2, m + 1)]
    assert (np.diff(widest) <= 1e-12).all()
