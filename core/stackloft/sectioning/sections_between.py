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

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.spatial.distance import pdist

from stackloft.geometry.equal_choices import least_of, points_ahead
from stackloft.geometry.plane_nodes import centred_nodes
from stackloft.geometry.polygon_distance import signed_distance
from stackloft.geometry.shoelace import polygon_area, polygon_centroid
from stackloft.model.arrays import FloatArray, frozen_ints
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.loop_links import bounding_box
from stackloft.sectioning.marching_squares import closed_lines
from stackloft.sectioning.traced_corners import with_corners

GRID = 160
"""Grid steps across the larger side of the loops' box."""
MARGIN = 3
FACING = 6.0
"""Grid steps between two corners below which neither is put back."""
LEAST = 1e-3
"""Loops smaller than this fraction of the box are noise of the interpolation."""
NEWTON = 6
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
    pitch: float
    """mm"""
    area: Callable[[float], float]
    """mm² that the loops should enclose at t"""
    sides: tuple[tuple[int, int], tuple[int, int]]
    """Outlines and holes of either section; the grid may join what comes closer than its step."""
    hollow: bool = False
    """True when the loops bound holes: background within, body around them."""

    def at(self, t: float) -> list[FloatArray]:
        """Return the loops a fraction t of the way from one section to the other."""
        return [evened(line, SIDES) for line in self._lines(t)]

    def loops_at(self, t: float, *, cornered: bool) -> list[Loop]:
        """Return the same loops, with their corners where the sections have some."""
        if not cornered:  # the tips of parts that have just come apart look like corners
            return [Loop(points) for points in self.at(t)]
        return [evened_loop(line, float(self.x[1] - self.x[0]), SIDES) for line in self._lines(t)]

    def _lines(self, t: float) -> list[FloatArray]:
        field = (1.0 - t) * self.before + t * self.after
        field = field - level_of_area(field, self.x[1] - self.x[0], self.area(t))
        lines = grid_lines(field, self.x, self.y)
        return [line[::-1] for line in lines] if self.hollow else lines


def between(
    before: list[FloatArray], after: list[FloatArray], pitch: float, area: Callable[[float], float]
) -> BetweenField:
    """Return the interpolator between the loops of two sections.

    Parameters
    ----------
    before, after : lists of (k, 2) arrays
        Polygons, mm, body on the left.
    pitch : float
        From one section to the other, mm.
    area : callable
        Area, mm², that the loops should enclose at t. Interpolated distances thin out where a slender part
        moves sideways; their level is set so that they do not.
    """
    x, y = plane_grid([*before, *after])
    largest = max([*before, *after], key=lambda p: abs(polygon_area(p)))
    fields = signed_distance(x, y, before), signed_distance(x, y, after)
    sides = topology(before), topology(after)
    return BetweenField(x, y, *fields, pitch, area, sides, hollow=polygon_area(largest) < 0.0)


def level_of_area(field: FloatArray, step: float, area: float) -> float:
    """Return the level above which a distance field on square cells covers an area.

    Examples
    --------
    >>> x = np.arange(-12.0, 12.5, 0.5)
    >>> field = 10.0 - np.hypot(x, x[:, None])
    >>> bool(abs(level_of_area(field, 0.5, 81.0 * np.pi) - 1.0) < 0.01)
    True
    """
    level = 0.0
    for _ in range(NEWTON):
        height = (field - level) / step
        covered = float(np.clip(height + 0.5, 0.0, 1.0).sum()) * step**2
        slope = float((np.abs(height) < 0.5).sum()) * step  # mm² per mm: about the perimeter
        if slope <= 0.0:
            break
        level += float(np.clip((covered - area) / slope, -2.0 * step, 2.0 * step))
    return level


def plane_grid(loops: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return node coordinates of a grid of square cells around loops, mm."""
    low, high = bounding_box(loops)
    step = float((high - low).max()) / GRID
    return centred_nodes(low, high, step, MARGIN)


def zero_lines(field: FloatArray, x: FloatArray, y: FloatArray) -> list[FloatArray]:
    """Return the closed lines on which a field on a grid is zero, evenly spaced vertices, (k, 2) mm each."""
    return [evened(line, SIDES) for line in grid_lines(field, x, y)]


def grid_lines(field: FloatArray, x: FloatArray, y: FloatArray) -> list[FloatArray]:
    """Return the closed lines on which a field on a grid is zero, a vertex on every grid side, (k, 2) mm."""
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
        if abs(polygon_area(points)) > LEAST**2 * size:
            loops.append(points)
    return loops


def evened(points: FloatArray, most: int) -> FloatArray:
    """Return a closed polygon with evenly spaced vertices, half as many as it has, at most `most`.

    It begins at the vertex farthest from the centre, wherever the line was begun.
    """
    points = _from_farthest(points)
    return _even_vertices(np.concatenate([points, points[:1]]), min(most, max(24, len(points) // 2)))


def _from_farthest(points: FloatArray) -> FloatArray:
    """Return a closed polygon begun at the vertex farthest from its centre."""
    away = np.linalg.norm(points - polygon_centroid(points), axis=1)
    return np.roll(points, -least_of(-away, points_ahead(points), float(away.max())), axis=0)


def evened_loop(points: FloatArray, pixel: float, most: int) -> Loop:
    """Return a line traced on a grid as a loop, its corners put back, the vertices between evenly spaced."""
    loop = with_corners(Loop(_from_farthest(points)), pixel)
    if not len(loop.corners) or _facing(loop.points[loop.corners]) < FACING * pixel:
        return Loop(evened(points, most))
    count = min(most, max(24, len(points) // 2))
    turned = np.roll(loop.points, -int(loop.corners[0]), axis=0)
    ends = [*(loop.corners - loop.corners[0]).tolist(), len(turned)]
    closed = np.concatenate([turned, turned[:1]])
    pieces = [closed[a : b + 1] for a, b in pairwise(ends)]
    lengths = [float(np.linalg.norm(np.diff(piece, axis=0), axis=1).sum()) for piece in pieces]
    sides = [max(2, round(count * length / sum(lengths))) for length in lengths]
    vertices = [_even_vertices(piece, n) for piece, n in zip(pieces, sides, strict=True)]
    corners = np.concatenate([[0], np.cumsum(sides)[:-1]])
    return Loop(np.concatenate(vertices), frozen_ints(corners))


def _facing(corners: FloatArray) -> float:
    """Return the least distance of two corners, mm: where a waist pinches, sharpened tips would cross."""
    return float(pdist(corners).min()) if len(corners) > 1 else np.inf


def _even_vertices(line: FloatArray, count: int) -> FloatArray:
    """Return a line's first `count` of `count + 1` evenly spaced vertices."""
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    wanted = arc[-1] * np.arange(count) / count
    return np.column_stack([np.interp(wanted, arc, line[:, k]) for k in (0, 1)])


def topology(loops: list[FloatArray]) -> tuple[int, int]:
    """Return the numbers of outlines and holes."""
    holes = sum(polygon_area(p) < 0.0 for p in loops)
    return len(loops) - holes, holes
