"""The rows a skin goes through: sections, and what closes them at both ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.creases import find_creases
from stackloft.geometry.skin import Rows

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class RowEnd:
    """How one end of the rows is closed."""

    length: float
    """mm beyond the outermost section; 0: the section is the plane face."""
    pole: bool
    """True: a pole; False: a plane face."""
    smooth: bool = True
    """At a pole: True for round (tangent plane across the axis), False for a sharp tip."""


def closed_rows(points: FloatArray, corners: BoolArray, ends: tuple[RowEnd, RowEnd]) -> Rows:
    """Return the rows of a closed solid.

    Parameters
    ----------
    points : (m, N, 3) array
        Corresponding points of the sections, mm; z constant along each row and increasing.
    corners : (m, N) bool array
        Corner points.
    ends : pair of RowEnd

    Returns
    -------
    Rows
        The sections with a pole, or an extrapolated plane rim, added at each end.
    """
    first, first_tangent = _end_row(points, ends[0])
    last, last_tangent = _end_row(points[::-1], ends[1])
    tangents = (first_tangent, None if last_tangent is None else -last_tangent)
    begin, stop = len(first), len(first) + len(points)
    rows = np.empty((3, points.shape[1], stop + len(last))).T  # as the skin wants it
    rows[:begin], rows[begin:stop], rows[stop:] = first, points, last
    marks = np.concatenate([corners[:1].repeat(begin, 0), corners, corners[-1:].repeat(len(last), 0)])
    return Rows(rows, marks, find_creases(rows), tangents)


def _end_row(points: FloatArray, end: RowEnd) -> tuple[FloatArray, FloatArray | None]:
    """Return the row to add before points[0] (or none) and the tangent there, pointing inwards."""
    if end.length == 0.0:
        return np.empty((0, *points.shape[1:])), None
    depth = np.abs(points[:, 0, 2] - points[0, 0, 2])
    outward = -1.0 if len(points) < 2 or points[1, 0, 2] > points[0, 0, 2] else 1.0
    z = points[0, 0, 2] + outward * end.length
    if not end.pole:
        return _extrapolated_rim(points, depth, end.length, z)[None], None
    pole = np.append(_extrapolate(points[:, :, :2].mean(axis=1), depth, end.length, order=2), z)
    row = np.broadcast_to(pole, (1, *points[0].shape))
    return row, _radial_tangent(points[0]) if end.smooth else None


def _radial_tangent(section: FloatArray) -> FloatArray:
    """Return dP/d(arc length) at a round pole: in the plane, in the section's shape, unit on average."""
    arm = section - section.mean(axis=0)
    return np.asarray(arm / np.linalg.norm(arm, axis=1).mean())


def _extrapolate(values: FloatArray, depth: FloatArray, length: float, order: int) -> FloatArray:
    """Return the value at depth -length of the polynomial through the outermost order + 1 rows."""
    count = min(order + 1, len(values))
    t = depth[:count]
    weights = np.array(
        [np.prod([(-length - t[j]) / (t[i] - t[j]) for j in range(count) if j != i]) for i in range(count)]
    )
    return np.asarray(np.tensordot(weights, values[:count], axes=1))


def _extrapolated_rim(points: FloatArray, depth: FloatArray, length: float, z: float) -> FloatArray:
    """Return the rim of a plane face beyond the outermost section.

    Continues the sides by the parabola through three sections where that is tame (within half a pitch
    and ±30 % of the radius), by the straight line otherwise, and straight along the axis at worst.
    """
    last = points[0, :, :2]
    size = np.linalg.norm(last - last.mean(axis=0), axis=1).mean()
    pitch = depth[1] if len(depth) > 1 else 0.0
    for order in (2, 1):
        if len(points) <= order or length > pitch / order:
            continue
        rim = _extrapolate(points[:, :, :2], depth, length, order)
        if np.linalg.norm(rim - last, axis=1).max() < 0.3 * size:
            return np.column_stack([rim, np.full(len(rim), z)])
    return np.column_stack([last, np.full(len(last), z)])
