r"""Sections between two given ones, where a body splits, merges, or closes round a hole.

::

    z1   ( )   ( )      two pieces
    ts    ()   ()       sections put in, ever closer to where the topology changes
    ts   (  )=(  )
    z0   (       )      one piece

A loft cut where the body really parts needs no wedge between the cut and the next section, whose volume
would hang on the pitch. The shapes are those of the interpolated signed distance (Raya & Udupa 1990, IEEE
Trans. Med. Imaging 9:32).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.polygon_distance import signed_distance
from stackloft.model.arrays import FloatArray
from stackloft.sectioning.loop_links import bounding_box
from stackloft.sectioning.marching_squares import closed_lines

GRID = 160
"""Grid steps across the larger side of the loops' box."""
MARGIN = 3
CLOSEST = 1.0 / 256.0
"""How closely, in pitches, the change of topology is bracketed."""
GRADES = (0.25, 1.0 / 16.0, 1.0 / 64.0)
"""Distances from the change, as fractions of the way to the given section, at which sections are put in."""
LEAST = 1e-3
"""Loops smaller than this fraction of the box are noise of the interpolation."""
SIDES = 160
"""Vertices of a loop that is put in."""


@dataclass(frozen=True, slots=True, eq=False)
class BetweenField:
    """The signed distances of two sections on one grid."""

    x: FloatArray
    y: FloatArray
    before: FloatArray
    """(rows, columns) mm, positive inside"""
    after: FloatArray

    def at(self, t: float) -> list[FloatArray]:
        """Return the loops a fraction t of the way from one section to the other."""
        field = (1.0 - t) * self.before + t * self.after
        return zero_lines(field, self.x, self.y)


def between(before: list[FloatArray], after: list[FloatArray]) -> BetweenField:
    """Return the interpolator between the loops (polygons, mm) of two sections."""
    x, y = plane_grid([*before, *after])
    return BetweenField(x, y, signed_distance(x, y, before), signed_distance(x, y, after))


def plane_grid(loops: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return node coordinates of a grid of square cells around loops, mm."""
    low, high = bounding_box(loops)
    step = float((high - low).max()) / GRID
    x, y = (
        np.arange(a - MARGIN * step, b + (MARGIN + 1) * step, step) for a, b in zip(low, high, strict=True)
    )
    return x, y


def zero_lines(field: FloatArray, x: FloatArray, y: FloatArray) -> list[FloatArray]:
    """Return the closed lines on which a field on a grid is zero, evenly spaced vertices, (k, 2) mm each."""
    inside = field > 0.0
    inside[[0, -1]] = False
    inside[:, [0, -1]] = False
    size = float(np.ptp(x) * np.ptp(y))
    loops = []
    for line in closed_lines(inside, field):
        row, column = line.row, line.column
        other_row, other_column = row + line.down, column + ~line.down
        f0, f1 = field[row, column], field[other_row, other_column]
        t = f0 / (f0 - f1)
        step = x[1] - x[0]
        points = np.column_stack([x[column] + t * step * ~line.down, y[row] + t * step * line.down])
        if abs(_area(points)) > LEAST**2 * size:
            loops.append(_evened(points))
    return loops


def _area(points: FloatArray) -> float:
    x, y = (points - points[0]).T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _evened(points: FloatArray) -> FloatArray:
    """Return the polygon with evenly spaced vertices."""
    closed = np.concatenate([points, points[:1]])
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    count = min(SIDES, max(24, len(points) // 2))
    wanted = arc[-1] * np.arange(count) / count
    return np.column_stack([np.interp(wanted, arc, closed[:, k]) for k in (0, 1)])


def change_levels(field: BetweenField) -> list[tuple[float, list[FloatArray]]]:
    """Return (t, loops) of levels about every change of topology between t = 0 and t = 1.

    The change is bracketed to `CLOSEST`; levels are put in on both sides of it.
    """
    ends = (_topology(field.at(0.0)), _topology(field.at(1.0)))
    marks: list[float] = [0.0]
    now = ends[0]
    while now != ends[1] and len(marks) < 2 * MOST_CHANGES + 1:
        low, high = _bracket(field, marks[-1], now)
        marks += [low, high]
        now = _topology(field.at(high))
    marks.append(1.0)
    levels: list[float] = []
    for start, stop in zip(marks[::2], marks[1::2], strict=True):
        length = stop - start
        graded = [start + length * g for g in GRADES] if start > 0.0 else []
        graded += [stop - length * g for g in reversed(GRADES)] if stop < 1.0 else []
        levels += [t for t in (start, *sorted(graded), stop) if 0.0 < t < 1.0]
    return [(t, field.at(t)) for t in sorted(set(levels))]


MOST_CHANGES = 6
"""Changes of topology looked for between two sections."""


def _bracket(field: BetweenField, start: float, now: tuple[int, int]) -> tuple[float, float]:
    """Return (last t with the topology `now`, first t with another)."""
    low, high = start, 1.0
    while high - low > CLOSEST:
        middle = 0.5 * (low + high)
        if _topology(field.at(middle)) == now:
            low = middle
        else:
            high = middle
    return low, high


def _topology(loops: list[FloatArray]) -> tuple[int, int]:
    """Return the numbers of outlines and holes."""
    holes = sum(_area(p) < 0.0 for p in loops)
    return len(loops) - holes, holes
