r"""Signed distance from the nodes of a plane grid to closed polygons: positive inside (even–odd).

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
    start = np.concatenate(polygons)
    following = np.concatenate([np.roll(polygon, -1, axis=0) for polygon in polygons])
    previous = np.concatenate([np.roll(polygon, 1, axis=0) for polygon in polygons])
    nodes = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    nearest = cKDTree(start).query(nodes)[1]
    distance = np.minimum(
        _to_side(nodes, start[nearest], following[nearest]),
        _to_side(nodes, previous[nearest], start[nearest]),
    )
    inside = inside_grid(x, y, start, following)
    return np.asarray(np.where(inside, 1.0, -1.0) * distance.reshape(inside.shape))


def inside_grid(x: FloatArray, y: FloatArray, start: FloatArray, end: FloatArray) -> BoolArray:
    """Return which grid nodes have an odd number of sides to their left, (rows, columns).

    Parameters
    ----------
    x, y : (columns,) and (rows,) arrays
    start, end : (n, 2) arrays
        The sides.
    """
    inside = np.zeros((len(y), len(x)), dtype=bool)
    for row, height in enumerate(y):
        across = (start[:, 1] > height) != (end[:, 1] > height)
        a, b = start[across], end[across]
        at = a[:, 0] + (height - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
        inside[row] = np.searchsorted(np.sort(at), x) % 2 == 1
    return inside


def _to_side(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    side = end - start
    squared = np.maximum((side**2).sum(axis=1), np.finfo(float).tiny)
    t = np.clip(((points - start) * side).sum(axis=1) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - start - t[:, None] * side, axis=1))
