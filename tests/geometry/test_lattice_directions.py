"""Directions and weights integrate what they promise, on any lattice."""

import numpy as np
import pytest

from stackloft.geometry.lattice_directions import DIRECTIONS, REACH, plain_directions, spaced_directions
from stackloft.testing.phantoms.pose import rotation_matrix

LATTICES = {
    "1:1": np.eye(3),
    "1:3": np.diag([1.0, 1.0, 3.0]),
    "1:10": np.diag([1.0, 1.0, 10.0]),
    "10:1": np.diag([0.02, 0.03, 0.002]),
    "sheared": np.array([[1.0, 0.0, 0.8], [0.0, 1.2, -0.5], [0.0, 0.0, 4.0]]),
}


@pytest.mark.parametrize("name", LATTICES)
def test_even_polynomials_to_degree_4_are_exact(name):
    basis = LATTICES[name]
    found = spaced_directions(basis)
    units = found.steps @ basis.T / found.lengths[:, None]
    assert found.weights.min() > 0
    turned = units @ rotation_matrix(3)
    x, y, z = turned.T
    for values, mean in (
        (x**0, 1),
        (x**2, 1 / 3),
        (x * y, 0),
        (z**4, 1 / 5),
        (x**2 * y**2, 1 / 15),
        (x**3 * z, 0),
    ):
        assert found.weights @ values == pytest.approx(mean, abs=1e-9)


@pytest.mark.parametrize("name", LATTICES)
def test_steps_are_whole_short_and_not_parallel(name):
    basis = LATTICES[name]
    found = spaced_directions(basis)
    assert found.steps.dtype == np.int64
    assert set(np.gcd.reduce(found.steps, axis=1)) == {1}
    assert len(found.steps) <= DIRECTIONS
    assert found.lengths.max() <= REACH * np.linalg.norm(basis, axis=0).max() * (1 + 1e-6)
    units = found.steps @ basis.T / found.lengths[:, None]
    cosines = np.abs(units @ units.T) - np.eye(len(units))
    assert cosines.max() < 1 - 1e-6


@pytest.mark.parametrize("name", LATTICES)
def test_turning_mirroring_and_scaling_the_lattice_changes_no_weight(name):
    basis = LATTICES[name]
    one = spaced_directions(basis)
    for matrix in (rotation_matrix(8), np.diag([-1.0, 1.0, 1.0]), 1e3 * np.eye(3)):
        other = spaced_directions(matrix @ basis)
        np.testing.assert_array_equal(one.steps, other.steps)
        np.testing.assert_allclose(one.weights, other.weights, rtol=1e-9)


def test_plain_directions_have_the_known_weights_of_cubic_voxels():
    # Voronoi shares of axes, face and body diagonals (Ohser & Muecklich 2000, table 5.2 to its three digits)
    weights = plain_directions(np.eye(3), 13).weights
    np.testing.assert_allclose(weights[:3] / 2, 0.0458, atol=2e-4)
    np.testing.assert_allclose(weights[3:9] / 2, 0.0370, atol=2e-4)
    np.testing.assert_allclose(weights[9:] / 2, 0.0352, atol=2e-4)
    assert weights.sum() == pytest.approx(1.0)
