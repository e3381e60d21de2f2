"""A bicubic skin through sections: cubic along each loop × cubic across sections.

The section curves lie on the skin exactly. Across sections the parameter is the arc length of the
columns, averaged over the loop: started from chords and refined once (Piegl & Tiller 1997, The NURBS Book,
§10.3); position along the axis is never a parameter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.bezier_patch import bernstein_slope
from stackloft.geometry.cubic_operators import broken_periodic_tangents, tangents_across

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

REFINEMENTS = 1
"""Once from chords to arc length: more moves volume and area by less than 2e-5."""
_GAUSS_X, _GAUSS_W = np.polynomial.legendre.leggauss(5)
_SLOPES = bernstein_slope(0.5 * (_GAUSS_X + 1.0))
_WEIGHTS = 0.5 * _GAUSS_W


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """What a skin goes through, from the first end to the last."""

    points: FloatArray
    """(n, N, 3) mm; a pole is a row of equal points."""
    corners: BoolArray
    """(n, N) where the row's curve turns sharply."""
    creases: BoolArray
    """(n,) rows at which the skin turns sharply."""
    tangents: tuple[FloatArray | None, FloatArray | None]
    """(N, 3) dP/d(arc length) along +v at the first and last row, or None where it is free."""


def skin(rows: Rows) -> FloatArray:
    """Return the Bézier patches of the skin.

    Parameters
    ----------
    rows : Rows

    Returns
    -------
    (n - 1, N, 4, 4, 3) array
        Control points [row, column, v, u], mm. They lie in memory as (4, 4, 3, N, n - 1).

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(32) / 32
    >>> ring = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    >>> tube = np.stack([ring, ring + [0, 0, 1.0], ring + [0, 0, 2.0]])
    >>> rows = Rows(tube, np.zeros((3, 32), bool), np.zeros(3, bool), (None, None))
    >>> skin(rows).shape
    (2, 32, 4, 4, 3)
    """
    curves = section_beziers(rows.points, rows.corners)
    ends = [
        None if tangent is None else section_beziers(tangent[None], corners[None])[0]
        for tangent, corners in zip(rows.tangents, (rows.corners[0], rows.corners[-1]), strict=True)
    ]
    return _across(curves, (ends[0], ends[1]), arc_length_nodes(rows), rows.creases)


def section_beziers(points: FloatArray, corners: BoolArray) -> FloatArray:
    """Return each row's closed curve as Bézier segments, (n, N, 4, d), for (n, N, d) points.

    Every row has the same, even parameter steps, so that the skin is one tensor product.
    """
    planes = _planes(points)
    if not corners.any():
        return _rows(_closed_beziers(planes, corners[0]))
    result = np.empty((4, *planes.shape))
    patterns, which = np.unique(corners, axis=0, return_inverse=True)
    for k, pattern in enumerate(patterns):
        chosen = np.flatnonzero(which.ravel() == k)
        result[..., chosen] = _closed_beziers(np.ascontiguousarray(planes[..., chosen]), pattern)
    return _rows(result)


def _planes(data: FloatArray) -> FloatArray:
    """Return (n, N, ...) data as (..., N, n), along each column from row to row: long rows add up fastest."""
    return np.ascontiguousarray(np.moveaxis(data, (1, 0), (-2, -1)))


def _rows(planes: FloatArray) -> FloatArray:
    """Return (..., N, n) data as (n, N, ...), where they lie."""
    return np.moveaxis(planes, (-1, -2), (0, 1))


def _closed_beziers(planes: FloatArray, breaks: BoolArray) -> FloatArray:
    """Return the Bézier segments, (4, d, N, n), of rows (d, N, n) that are broken at the same points."""
    arriving, leaving = broken_periodic_tangents(np.ones(planes.shape[1]), breaks)
    out = leaving @ planes
    into = out if arriving is leaving else arriving @ planes
    beziers = np.empty((4, *planes.shape))
    beziers[0] = planes
    beziers[3, :, :-1], beziers[3, :, -1] = planes[:, 1:], planes[:, 0]
    np.multiply(out, 1.0 / 3.0, out=beziers[1])
    beziers[1] += planes
    beziers[2, :, :-1], beziers[2, :, -1] = into[:, 1:], into[:, 0]
    beziers[2] *= -1.0 / 3.0
    beziers[2] += beziers[3]
    return beziers


def arc_length_nodes(rows: Rows) -> FloatArray:
    """Return the rows' parameters: arc length along the columns, averaged over the loop, mm."""
    planes = _planes(rows.points)
    step = _lengths(np.diff(planes)).mean(axis=0)
    step = np.maximum(step, 1e-12 * step.sum())
    for _ in range(REFINEMENTS):
        nodes = np.concatenate([[0.0], np.cumsum(step)])
        columns = np.moveaxis(_across(rows.points, rows.tangents, nodes, rows.creases), (2, 3, 1), (0, 1, 2))
        step = np.zeros(len(nodes) - 1)
        for slope, weight in zip(_SLOPES, _WEIGHTS, strict=True):
            step += weight * _lengths(np.tensordot(slope, columns, 1)).mean(axis=0)
    return np.concatenate([[0.0], np.cumsum(step)])


def _lengths(planes: FloatArray) -> FloatArray:
    """Return the lengths of vectors, (N, n) of (3, N, n)."""
    return np.asarray(np.sqrt((planes * planes).sum(axis=0)))


def _across(
    data: FloatArray, ends: tuple[FloatArray | None, FloatArray | None], nodes: FloatArray, creases: BoolArray
) -> FloatArray:
    """Return Bézier points across rows, (n - 1, N, 4, ...), of data (n, N, ...) at the nodes.

    `ends` are the tangents, (N, ...), at the first and the last row, None where they are free.
    """
    planes = _planes(data)
    first, last = (None if end is None else np.moveaxis(end, 0, -1).ravel() for end in ends)
    values = planes.reshape(-1, len(nodes))
    arriving, leaving = tangents_across(nodes, creases, values.T, (first, last))
    third = np.diff(nodes) / 3.0
    beziers = np.empty((4, len(values), len(third)))
    beziers[0], beziers[3] = values[:, :-1], values[:, 1:]
    np.multiply(leaving[:-1].T, third, out=beziers[1])
    beziers[1] += beziers[0]
    np.multiply(arriving[1:].T, -third, out=beziers[2])
    beziers[2] += beziers[3]
    return _rows(beziers.reshape(4, *planes.shape[:-1], len(third)))
