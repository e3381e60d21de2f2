r"""Signed distance from a plane grid's nodes, or any points, to closed polygons: positive inside (even–odd).

::

    o   o   o   o   o        distance: to the two sides at the nearest vertex
    o   o .---. o   o        sign: how many sides lie on the row to the left of the node
    o   o/  +  \o   o
    o   o`-----'o   o
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

AT_ONCE = 100_000
"""Pairs of a row and a side looked at together."""


def signed_distance(x: FloatArray, y: FloatArray, polygons: list[FloatArray]) -> FloatArray:
    """Return the distance of grid nodes to the nearest side, mm, negative outside.

    Parameters
    ----------
    x, y : (columns,) and (rows,) arrays
        Node coordinates, increasing, mm.
    polygons : list of (k, 2) arrays
        Closed loops, holes among them; inside is what an odd number of them encloses. Sides should not be
        longer than the grid's steps: only those at the nearest vertex are looked at.

    Returns
    -------
    (rows, columns) array

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(200) / 200
    >>> ring = 3.0 * np.column_stack([np.cos(t), np.sin(t)])
    >>> signed_distance(np.array([0.0, 1.0, 5.0]), np.array([0.0]), [ring]).round(2)
    array([[ 3.,  2., -2.]])
    """
    nodes = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    inside = inside_grid(x, y, *_sides(polygons))
    return np.asarray(np.where(inside, 1.0, -1.0) * _distance(nodes, polygons).reshape(inside.shape))


def signed_distance_at(points: FloatArray, polygons: list[FloatArray]) -> FloatArray:
    """Return the distance of any (n, 2) points to the nearest side, mm, negative outside, (n,).

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    >>> signed_distance_at(np.array([[1.5, 1.0], [3.0, 1.0]]), [square]).tolist()
    [0.5, -1.0]
    """
    start, end = _sides(polygons)
    x, y = points[:, :1], points[:, 1:]
    across = (start[:, 1] > y) != (end[:, 1] > y)
    rise = np.where(end[:, 1] == start[:, 1], 1.0, end[:, 1] - start[:, 1])
    at = start[:, 0] + (y - start[:, 1]) * (end[:, 0] - start[:, 0]) / rise
    inside = np.count_nonzero(across & (at < x), axis=1) % 2 == 1
    return np.asarray(np.where(inside, 1.0, -1.0) * _distance(points, polygons))


def _sides(polygons: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return where the polygons' sides start and end, (n, 2) each."""
    return np.concatenate(polygons), np.concatenate([np.roll(one, -1, axis=0) for one in polygons])


def _distance(points: FloatArray, polygons: list[FloatArray]) -> FloatArray:
    """Return the distance to the two sides at the nearest vertex."""
    start, following = _sides(polygons)
    previous = np.concatenate([np.roll(polygon, 1, axis=0) for polygon in polygons])
    nearest = cKDTree(start).query(points)[1]
    return np.minimum(
        _to_side(points, start[nearest], following[nearest]),
        _to_side(points, previous[nearest], start[nearest]),
    )


def inside_grid(x: FloatArray, y: FloatArray, start: FloatArray, end: FloatArray) -> BoolArray:
    """Return which grid nodes have an odd number of sides to their left, (rows, columns).

    Parameters
    ----------
    x, y : (columns,) and (rows,) arrays
        x increasing.
    start, end : (n, 2) arrays
        The sides.
    """
    parts = [np.zeros((0, len(x)), dtype=bool)]
    together = max(1, AT_ONCE // max(1, len(start)))
    for first in range(0, len(y), together):
        height = y[first : first + together, None]
        row, side = np.nonzero((start[:, 1] > height) != (end[:, 1] > height))
        a, b = start[side], end[side]
        at = a[:, 0] + (height[row, 0] - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
        begin = row * (len(x) + 1) + np.searchsorted(x, at, side="right")
        begun = np.bincount(begin, minlength=len(height) * (len(x) + 1)).reshape(len(height), -1)
        parts.append(np.cumsum(begun[:, :-1], axis=1) % 2 == 1)
    return np.concatenate(parts)


def _to_side(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    side = end - start
    squared = np.maximum((side**2).sum(axis=1), np.finfo(float).tiny)
    t = np.clip(((points - start) * side).sum(axis=1) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - start - t[:, None] * side, axis=1))
