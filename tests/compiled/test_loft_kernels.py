"""The loft's compiled kernels give what NumPy and LAPACK give."""

from dataclasses import fields

import numpy as np
import pytest

from stackloft.compiled.library import kernels, without_kernels
from stackloft.compiled.ring_chain import LONGEST, solve_rings
from stackloft.compiled.slide_system import slide_system
from stackloft.geometry import correspondence
from stackloft.geometry.curve_stack import CurveStack, fit_curves

pytestmark = pytest.mark.skipif(kernels() is None, reason="no compiled kernels here")
TOLERANCE = 1e-10
"""NumPy's parameter runs on over all arcs, so that the shortest steps lose digits; the kernel's does not."""


def random_rings(rng, rings, around):
    """Return a diagonally dominant chain of rings, a few of whose unknowns are held by huge coefficients."""
    along = -rng.uniform(0.5, 2.0, (rings, around))
    across = -rng.uniform(0.5, 30.0, (rings, around))
    across[-1] = 0.0
    diagonal = 0.1 - along - np.roll(along, 1, axis=1) - across
    diagonal[1:] -= across[:-1]
    held = rng.random((rings, around)) < 0.05
    diagonal[held] += 1e12 * diagonal.max()
    right = rng.normal(size=(rings, around))
    right[held] = 0.0
    return diagonal, along, across, right


@pytest.mark.parametrize(
    ("rings", "around"), [(2, 3), (2, 4), (9, 5), (3, 7), (40, 32), (41, 33), (20, LONGEST)]
)
def test_chains_of_rings_have_the_solution_that_lapack_finds(rings, around):
    rng = np.random.default_rng(rings)
    for _ in range(20):
        system = random_rings(rng, rings, around)
        reference = correspondence._solved(*system)
        scale = abs(reference).max()
        np.testing.assert_allclose(solve_rings(*system), reference, rtol=0.0, atol=1e-12 * scale)


def test_chains_that_are_not_positive_definite_or_too_long_are_left_to_lapack():
    rng = np.random.default_rng(1)
    diagonal, along, across, right = random_rings(rng, 6, 8)
    diagonal[3, 2] = -1.0
    assert solve_rings(diagonal, along, across, right) is None
    assert solve_rings(*random_rings(rng, 2, 2)) is None
    assert solve_rings(*random_rings(rng, 2, LONGEST + 1)) is None
    with without_kernels():
        assert solve_rings(*random_rings(rng, 6, 8)) is None


@pytest.mark.parametrize(("rings", "around"), [(2, 3), (5, 9), (40, 33)])
def test_systems_of_sliding_points_are_the_same_numbers(rings, around):
    rng = np.random.default_rng(rings)
    for _ in range(20):
        first = np.sort(rng.uniform(0.0, 1.0, (rings, around)), axis=1) + rng.uniform(-2.0, 2.0)
        current = first + rng.normal(size=first.shape) * 1e-3
        on_curves = tuple(np.moveaxis(rng.normal(size=(2, 2, rings, around)), 1, -1))
        fractions = current, first, correspondence._gaps(first)
        weights = rng.uniform(0.1, 5.0, rings - 1), rng.uniform(0.1, 5.0, rings)
        fixed = rng.random(first.shape) < 0.2
        costs = correspondence.EVENNESS, correspondence.HOLD
        found = slide_system(on_curves, fractions, weights, costs, (fixed, correspondence.HUGE))
        for own, other in zip(
            found, correspondence._system(on_curves, fractions, weights, fixed), strict=True
        ):
            np.testing.assert_allclose(own, other, rtol=1e-12, atol=1e-14 * abs(other[~fixed]).max())


def random_loops(rng, count, fewest=3, power=4):
    """Return closed loops of one stack, some with corners, at even steps, uneven and very uneven ones."""
    loops, corners = [], []
    for _ in range(count):
        vertices = int(rng.integers(fewest, 400))
        t = np.arange(vertices) / vertices
        t = rng.choice([t, t + rng.uniform(0.0, 0.7, vertices) / vertices, t**power])
        t = 2.0 * np.pi * np.unique(t)
        radius = 5.0 + 0.5 * np.cos(3.0 * t + rng.uniform(0.0, 6.0))
        loops.append(np.column_stack([radius * np.cos(t) + 40.0, radius * np.sin(t) - 7.0]))
        marks = rng.choice(len(t), int(rng.integers(0, 1 + min(len(t), 5))), replace=False)
        corners.append(np.sort(marks) if rng.random() < 0.5 else np.empty(0, np.int64))
    return loops, corners


@pytest.mark.parametrize("flip", [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])
def test_points_and_slopes_on_curves_are_the_same_numbers(flip):
    rng = np.random.default_rng(2)
    for _ in range(20):
        curves = fit_curves(*random_loops(rng, 12)).flipped(flip)
        inside = (curves.knots[:-1] - np.floor(curves.knots[:-1]))[:40]
        samples = np.concatenate([rng.uniform(-3.0, 3.0, 60), np.arange(65) / 64, inside])
        across = np.arange(12)[:, None], samples[None, :]
        listed = rng.integers(0, 12, 125), np.sort(rng.uniform(0.0, 1.0, 125))
        at_knots = np.zeros(len(inside), np.int64), inside - curves.starts[0]
        for section, s in (across, listed, at_knots):
            found = curves.at(section, s)
            with without_kernels():
                reference = curves.at(section, s)
            for own, other in zip(found, reference, strict=True):
                assert np.array_equal(own, other)


def test_what_is_no_section_or_no_number_is_told_as_numpy_tells_it():
    curves = fit_curves(*random_loops(np.random.default_rng(3), 2))
    with pytest.raises(IndexError):
        curves.at(np.array([2]), np.zeros(1))
    for s in (np.nan, np.inf):
        with np.errstate(invalid="ignore"):
            assert np.isnan(curves.at(np.array([1]), np.array([s]))[0]).all()


@pytest.mark.parametrize("fewest", [3, 130])
def test_fitted_curves_are_the_same(fewest):
    """Four Gauss points on each segment, or two where all loops have many vertices."""
    rng = np.random.default_rng(4)
    for _ in range(40):
        loops, corners = random_loops(rng, int(rng.integers(1, 9)), fewest, 2)
        found = fit_curves(loops, corners)
        with without_kernels():
            reference = fit_curves(loops, corners)
        for field in fields(CurveStack):
            own, other = (np.asarray(getattr(each, field.name)) for each in (found, reference))
            scale = max(1.0, abs(other).max())
            turns = np.rint(own - other) if field.name == "starts" else 0.0  # half a turn may be minus half
            np.testing.assert_allclose(
                own - turns, other, rtol=0.0, atol=TOLERANCE * scale, err_msg=field.name
            )
