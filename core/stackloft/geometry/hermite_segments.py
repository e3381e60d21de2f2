r"""Closed loops' end tangents, segment by segment, from splines that are broken at the corners.

::

    loop of k vertices          arc of a loop without corners: it runs on over itself by WRAP nodes
       1 ---- 2                    k-2  k-1 | 0  1  2 … k-1  0 | 1  2
       |      |                              ^^^^^^^^^^^^^^^^ the segments that count
       0 ---- 3                 with corners: from one to the next, every segment counts
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arc_tangents import arc_tangents
from stackloft.geometry.arc_splines import WRAP, spline_tangents

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def segment_tangents(
    planes: FloatArray, first: IntArray, corners: list[IntArray]
) -> tuple[FloatArray, FloatArray]:
    """Return dP/dx at the starts and at the ends of all loops' segments, x in [0, 1] along each.

    Parameters
    ----------
    planes : (2, n) array
        x and y of the vertices, loop after loop, mm; segment i leaves vertex i.
    first : (m + 1,) int array
        First vertex of each loop.
    corners : list of (c_i,) int arrays
        Vertices of each loop, counted from its first, at which the curve may turn sharply.

    Returns
    -------
    leaving, arriving : (2, n) arrays

    Examples
    --------
    >>> square = np.array([[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]])
    >>> leaving, arriving = segment_tangents(square, np.array([0, 4]), [np.arange(4)])
    >>> leaving.tolist() == arriving.tolist() == [[1.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, -1.0]]
    True
    """
    arcs = _arcs(np.diff(first), corners)
    found = arc_tangents(planes, first, arcs)
    return _all_tangents(planes, first, arcs) if found is None else found


def _all_tangents(planes: FloatArray, first: IntArray, arcs: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return what `arc_tangents` does, all arcs at once."""
    owner, begin, nodes, lead = arcs.T
    starts = np.cumsum(nodes) - nodes
    vertex = np.arange(nodes.sum()) + np.repeat(begin - starts, nodes)
    vertex %= np.repeat(np.diff(first)[owner], nodes)
    vertex += np.repeat(first[owner], nodes)
    points = planes.take(vertex, axis=1)
    x, y = np.diff(points)
    chord = np.sqrt(x * x + y * y)
    along = np.concatenate([[0.0], np.cumsum(np.maximum(chord, 1e-300))])
    tangents = spline_tangents(along, points.T, starts).T
    counted = nodes - 1 - 2 * lead
    at = np.arange(counted.sum()) + np.repeat(starts + lead - (np.cumsum(counted) - counted), counted)
    segment, length = vertex.take(at), chord.take(at)
    leaving, arriving = np.empty_like(planes), np.empty_like(planes)
    for k in (0, 1):
        leaving[k][segment] = tangents[k].take(at) * length
        arriving[k][segment] = tangents[k].take(at + 1) * length
    return leaving, arriving


def _arcs(counts: IntArray, corners: list[IntArray]) -> IntArray:
    """Return of each arc its loop, first vertex, nodes, and nodes at either end that only lead in or out."""
    whole = np.array([len(marks) == 0 for marks in corners])
    loop = np.flatnonzero(whole)
    wrap = np.minimum(WRAP, 4 * counts[loop])
    closed = np.stack([loop, -wrap, counts[loop] + 2 * wrap + 1, wrap], axis=1)
    broken = []
    for k in np.flatnonzero(~whole):
        begin = np.sort(corners[k])
        nodes = np.diff(begin, append=begin[0] + counts[k]) + 1
        broken.append(np.stack([np.full(len(begin), k), begin, nodes, np.zeros_like(begin)], axis=1))
    arcs = np.concatenate([closed, *broken])
    in_order: IntArray = arcs[np.argsort(arcs[:, 0], kind="stable")]
    return in_order
