r"""The ellipse that has a section's area moments: how long and how wide the section is, however it lies.

::

        ____
      _/    \_          The half-axes 2 √λ of the covariance of the points within: those of an ellipse
     (   +    )         are its own. Neither moving nor turning the section changes them.
      \______/
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def half_axes(polygon: FloatArray) -> FloatArray:
    """Return the longer and the shorter half-axis, (..., 2).

    Parameters
    ----------
    polygon : array (..., k, 2)
        Simple; in any unit.

    Examples
    --------
    >>> t = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
    >>> half_axes(9 + np.column_stack([3 * np.cos(t), 2 * np.sin(t)])).round(4).tolist()
    [3.0, 2.0]
    """
    matrix, _ = central_moments(polygon)
    axes: FloatArray = 2 * np.sqrt(np.clip(np.linalg.eigvalsh(matrix)[..., ::-1], 0, None))
    return axes


def central_moments(polygon: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the covariance of the points within, (..., 2, 2), and their centre, (..., 2).

    Parameters
    ----------
    polygon : array (..., k, 2)
        Simple; in any unit.

    Examples
    --------
    >>> matrix, centre = central_moments(np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 12.0], [0.0, 12.0]]))
    >>> matrix.round(9).tolist(), centre.tolist()
    ([[3.0, 0.0], [0.0, 12.0]], [3.0, 6.0])
    """
    middle = polygon.mean(axis=-2)
    start = polygon - middle[..., None, :]
    end = np.roll(start, -1, axis=-2)
    cross = start[..., 0] * end[..., 1] - end[..., 0] * start[..., 1]
    area = cross.sum(axis=-1)[..., None] / 2
    centre = ((start + end) * cross[..., None]).sum(axis=-2) / (6 * area)
    sums = _products(cross, start, start) + _products(cross, end, end)
    mixed = _products(cross, start, end)
    matrix = (sums + 0.5 * (mixed + np.swapaxes(mixed, -1, -2))) / (12 * area[..., None])
    return matrix - centre[..., :, None] * centre[..., None, :], middle + centre


def _products(weights: FloatArray, one: FloatArray, two: FloatArray) -> FloatArray:
    """Return the sum over vertices of the weighted outer products, (..., 2, 2)."""
    total: FloatArray = np.einsum("...k,...ki,...kj->...ij", weights, one, two)
    return total
