"""How much of every pixel a polygon covers, exactly.

::

        col 0   1   2            Each piece of an edge lies in one pixel. To the right of it its whole
       +---+---+---+             height dy counts, in its own pixel the part right of it; sums along
    r  |   | /#|###|             the row (the signed-area accumulation buffer of font rasterisers)
       +---+---+---+             give each pixel's covered area without any sampling.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray


def coverage(polygons: Sequence[FloatArray], shape: tuple[int, int]) -> FloatArray:
    """Return the covered part of every pixel, (rows, columns) from 0 to 1.

    Parameters
    ----------
    polygons : sequence of array (k, 2)
        Closed polygons (x, y) in pixels, pixel (row i, column j) being [j, j+1] × [i, i+1]. Outer ones
        counter-clockwise in (x, y), holes clockwise. Parts outside the picture are cut off.
    shape : (rows, columns)

    Examples
    --------
    >>> triangle = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])
    >>> coverage([triangle], (2, 3)).tolist()
    [[1.0, 0.5, 0.0], [0.5, 0.0, 0.0]]
    """
    rows, columns = shape
    sums = np.zeros(rows * (columns + 2))
    for polygon in polygons:
        start, end = _pieces(polygon, np.roll(polygon, -1, axis=0))
        middle = (start + end) / 2
        row = np.floor(middle[:, 1]).astype(int)
        x = np.clip(middle[:, 0], 0, columns)
        column = np.floor(x).astype(int)
        rise = np.where((row >= 0) & (row < rows), end[:, 1] - start[:, 1], 0.0)
        place = np.clip(row, 0, rows - 1) * (columns + 2) + column
        right = rise * (x - column)
        sums += np.bincount(place, right - rise, sums.size) + np.bincount(place + 1, -right, sums.size)
    covered: FloatArray = np.cumsum(sums.reshape(rows, columns + 2), axis=1)[:, :columns]
    return np.clip(covered, 0, 1)


def _pieces(start: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the edges cut wherever they pass from one pixel to the next, starts and ends (p, 2)."""
    edges = [np.arange(len(start))] * 2
    where = [np.zeros(len(start)), np.ones(len(start))]
    for axis in (0, 1):
        edge, t = _line_crossings(start[:, axis], end[:, axis])
        edges.append(edge)
        where.append(t)
    edge, t = np.concatenate(edges), np.concatenate(where)
    order = np.lexsort((t, edge))
    edge, t = edge[order], t[order]
    points = start[edge] + t[:, None] * (end - start)[edge]
    same = edge[:-1] == edge[1:]
    return points[:-1][same], points[1:][same]


def _line_crossings(a: FloatArray, b: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return for every whole number strictly between a and b of an edge: the edge and the parameter."""
    low, high = np.minimum(a, b), np.maximum(a, b)
    first = np.floor(low) + 1
    count = np.maximum(np.ceil(high) - first, 0).astype(int)
    edge = np.repeat(np.arange(len(a)), count)
    step = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    whole = first[edge] + step
    return edge, (whole - a[edge]) / (b - a)[edge]
