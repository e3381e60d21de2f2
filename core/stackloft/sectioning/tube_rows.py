"""The loops of a tube."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree

from stackloft.geometry.bridge_edges import Part
from stackloft.model.arrays import BoolArray, FloatArray, IntArray, frozen_ints
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.levels import Level, is_hole

SAME = 1e-9
"""Points closer than this fraction of the loop are one."""
SHORT_CHORD = 0.02
"""A cut shorter than this fraction of the loop is drawn as one corner."""


@dataclass(slots=True, eq=False)
class Row:
    """A loop of a tube."""

    z: float
    loop: Loop
    name: str
    section: int | None
    hole: bool
    pinned: bool = False
    """True where the corners are the ends of a joint's edges."""


@dataclass(frozen=True, slots=True)
class JointUse:
    """A tube's end at a joint."""

    joint: int
    edges: tuple[tuple[int, bool], ...]


@dataclass(slots=True, eq=False)
class TubeOfLoops:
    """Loops that go on one to one."""

    rows: list[Row]
    ends: list[JointUse | float] = field(default_factory=list)
    """For the first and last row: the joint, or the mm to the level without it (inf: no level)."""

    @property
    def hole(self) -> bool:
        """True for a hole or cavity."""
        return self.rows[0].hole


def level_rows(level: Level) -> list[Row]:
    """Return a level's loops as rows of tubes."""
    return [
        Row(level.z, loop, level.name, level.section, is_hole(p))
        for loop, p in zip(level.loops, level.polygons, strict=True)
    ]


def pinned_row(row: Row, whole: Part) -> Row:
    """Return the row with its corners at the joint's pins, on the joint's own polygon."""
    if not whole.pinned.size:
        return row
    corners = np.union1d(whole.pinned, _vertices_at(whole.points, [row.loop]))
    return Row(row.z, Loop(whole.points, frozen_ints(corners)), row.name, row.section, row.hole, pinned=True)


def part_row(part: Part, level: Level, hole: bool) -> Row:
    """Return a part of a cut loop as a row, its corners at the joint's pins."""
    points, pinned = _without_short_chords(part)
    corners = np.union1d(pinned, _vertices_at(points, level.loops))
    return Row(level.z, Loop(points, frozen_ints(corners)), level.name, None, hole, pinned=True)


def _vertices_at(points: FloatArray, loops: Iterable[Loop]) -> IntArray:
    """Return the vertices that lie on corners of the loops."""
    corners = np.concatenate([loop.points[loop.corners] for loop in loops])
    if not len(corners):
        return np.empty(0, dtype=np.int64)
    distance, nearest = cKDTree(points).query(corners)
    return np.asarray(nearest, dtype=np.int64)[distance <= SAME * float(np.ptp(points))]


def _without_short_chords(part: Part) -> tuple[FloatArray, IntArray]:
    """Return points and corners, both ends of a very short chord drawn as one corner half-way."""
    points = part.points.copy()
    n = len(points)
    side = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    dropped: BoolArray = np.zeros(n, dtype=bool)
    pins = set(part.pinned.tolist())
    for k in part.pinned:
        following = (k + 1) % n
        if following in pins and side[k] < SHORT_CHORD * side.sum() and not dropped[k]:
            points[k] = 0.5 * (points[k] + points[following])
            dropped[following] = True
    place = np.cumsum(~dropped) - 1
    corners = np.array([place[k] for k in part.pinned if not dropped[k]], dtype=np.int64)
    return points[~dropped], corners
