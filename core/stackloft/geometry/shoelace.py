"""Area, centroid and perimeter of closed polygons (shoelace formula; Green 1828)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def polygon_area(points: FloatArray) -> float:
    """Return the signed area of a closed polygon.

    Parameters
    ----------
    points : (k, 2) array
        Vertices in order, mm; the last is joined to the first.

    Returns
    -------
    float
        mm², positive when counter-clockwise.

    Examples
    --------
    >>> polygon_area(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]))
    2.0
    """
    # the first vertex is the origin, so the closing edge adds nothing; by columns, as rows of two take longer
    x, y = points[:, 0] - points[0, 0], points[:, 1] - points[0, 1]
    return 0.5 * float(_dot(x[:-1], y[1:]) - _dot(y[:-1], x[1:]))


def _dot(a: FloatArray, b: FloatArray) -> float:
    """Return Σ a b; not by BLAS, which wakes threads of its own for ten thousand vertices."""
    return float(np.einsum("i,i->", a, b))


def polygon_perimeter(points: FloatArray) -> float:
    """Return the perimeter, mm, of a closed polygon given as (k, 2) vertices."""
    x, y = (np.subtract(np.append(c[1:], c[:1]), c) for c in points.T)
    return float(np.sqrt(x * x + y * y).sum())


def polygon_centroid(points: FloatArray) -> FloatArray:
    """Return the area centroid (x, y), mm, of a closed polygon given as (k, 2) vertices.

    Examples
    --------
    >>> polygon_centroid(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]))
    array([1. , 0.5])
    """
    local = points - points[0]
    following = np.roll(local, -1, axis=0)
    cross = local[:, 0] * following[:, 1] - local[:, 1] * following[:, 0]
    total = cross.sum()
    if total == 0.0:
        return np.asarray(points.mean(axis=0))
    moments: FloatArray = ((local + following) * cross[:, None]).sum(axis=0) / (3.0 * total)
    centroid: FloatArray = points[0] + moments
    return centroid
