"""Which closed polygons cross themselves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


def crosses_itself(points: FloatArray) -> BoolArray:
    """Return for each polygon whether two of its edges cross properly.

    Parameters
    ----------
    points : (m, N, 2) array
        Vertices of m closed polygons.

    Returns
    -------
    (m,) bool array
        Touching in a vertex or along an edge is no crossing.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> crosses_itself(np.stack([square, square[[0, 2, 1, 3]]])).tolist()
    [False, True]
    """
    return np.array([_crosses(polygon) for polygon in points])


def _crosses(points: FloatArray) -> bool:
    start, end = points, np.roll(points, -1, axis=0)
    edge = end - start
    side_of_start = _side(start, edge, start)
    side_of_end = np.roll(side_of_start, -1, axis=1)
    apart = side_of_start * side_of_end < 0.0  # [i, j]: edge j's ends lie on both sides of edge i's line
    return bool((apart & apart.T).any())


def _side(start: FloatArray, edge: FloatArray, points: FloatArray) -> FloatArray:
    """Return [i, j]: twice the area of (edge i, point j), signed by the side; 0 within rounding."""
    x = points[None, :, 0] - start[:, None, 0]
    y = points[None, :, 1] - start[:, None, 1]
    area = edge[:, None, 0] * y - edge[:, None, 1] * x
    size = np.abs(points - points[0]).max() ** 2
    return np.asarray(np.where(np.abs(area) > 1e-12 * size, area, 0.0))
