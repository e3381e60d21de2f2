"""The loft's compiled kernels give what NumPy and LAPACK give."""

import numpy as np
import pytest

from stackloft.compiled.library import kernels, without_kernels
from stackloft.compiled.ring_chain import LONGEST, solve_rings
from stackloft.geometry import correspondence

pytestmark = pytest.mark.skipif(kernels() is None, reason="no compiled kernels here")


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
