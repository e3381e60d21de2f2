"""Signed distances to polygons on a grid."""

import numpy as np
import pytest

from stackloft.geometry.polygon_distance import signed_distance


def circle(radius, count=2000):
    t = 2 * np.pi * np.arange(count) / count
    return radius * np.column_stack([np.cos(t), np.sin(t)])


def test_a_circle():
    x, y = np.linspace(-7, 7, 41), np.linspace(-6, 8, 37)
    found = signed_distance(x, y, [circle(4.0)])
    np.testing.assert_allclose(found, 4.0 - np.hypot(x[None, :], y[:, None]), atol=1e-5)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_hole_is_outside_whichever_way_it_runs(direction):
    x = np.array([0.0, 1.5, 3.0, 5.0])
    found = signed_distance(x, np.array([0.0]), [circle(4.0), circle(2.0)[::direction]])
    np.testing.assert_allclose(found[0], [-2.0, -0.5, 1.0, -1.0], atol=1e-5)


def test_a_polygon_of_short_sides_is_exact_beside_its_corners():
    side = np.arange(0, 4, 0.25)
    square = np.concatenate(
        [
            np.column_stack([side, 0 * side]),
            np.column_stack([4 + 0 * side, side]),
            np.column_stack([4 - side, 4 + 0 * side]),
            np.column_stack([0 * side, 4 - side]),
        ]
    )
    x = np.linspace(-1.03, 5.07, 50)
    a, b = np.meshgrid(x, x)
    q = np.stack([np.abs(a - 2) - 2, np.abs(b - 2) - 2])
    exact = -(np.linalg.norm(np.maximum(q, 0), axis=0) + np.minimum(q.max(axis=0), 0))
    np.testing.assert_allclose(signed_distance(x, x, [square]), exact, atol=2e-3 + 0.01)
