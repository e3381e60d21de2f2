r"""What the loops of a section bound: pieces of the body, and the background around and within them.

::

    +-----------------+
    |   +--------+    |     loop 0: piece {0, 1}, background outside
    |   | hole   |    |     loop 1: piece {0, 1}, background the hole
    |   |  +--+  |    |     loop 2: piece {2}, background the hole
    |   |  +--+  |    |
    |   +--------+    |
    +-----------------+

Two loops of neighbouring sections belong together when both what they bound and what lies beyond them do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.polygon_distance import inside_grid
from stackloft.model.arrays import BoolArray, FloatArray
from stackloft.sectioning.nesting import enclosing_loops

OUTSIDE = -1
GRID = 64
"""Nodes along each side of the box in which the overlap of two regions is counted."""


@dataclass(frozen=True, slots=True, eq=False)
class Regions:
    """The loops of one section as pieces of body and background."""

    loops: tuple[FloatArray, ...]
    """(k, 2) mm: polygons of short sides"""
    holes: BoolArray
    """(n,) whether the loop bounds a hole"""
    parents: tuple[int, ...]
    """The loop directly around each loop, or OUTSIDE."""

    def piece(self, loop: int) -> int:
        """Return the outer loop of the piece of body that a loop bounds."""
        return self.parents[loop] if self.holes[loop] else loop

    def background(self, loop: int) -> int:
        """Return the hole beyond a loop, or OUTSIDE."""
        return loop if self.holes[loop] else self.parents[loop]

    def within(self, loop: int) -> list[FloatArray]:
        """Return the polygons of the region directly inside a loop: body in an outer one, else background."""
        return [
            self.loops[loop],
            *(p for p, parent in zip(self.loops, self.parents, strict=True) if parent == loop),
        ]

    def outermost(self) -> list[FloatArray]:
        """Return the loops that nothing encloses."""
        return [p for p, parent in zip(self.loops, self.parents, strict=True) if parent == OUTSIDE]


def section_regions(loops: list[FloatArray], name: str = "") -> Regions:
    """Return the regions of a section's loops, outer or hole by how deep they are nested.

    Raises
    ------
    InputError
        Two loops cross.

    Examples
    --------
    >>> square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    >>> found = section_regions([3 * square, 2 * square, square])
    >>> found.holes.tolist(), found.parents
    ([False, True, False], (-1, 0, 1))
    """
    around = enclosing_loops(loops, name)
    depth = [len(a) for a in around]
    parents = tuple(max(a, key=lambda k: depth[k]) if a else OUTSIDE for a in around)
    return Regions(tuple(loops), np.array([d % 2 == 1 for d in depth], dtype=bool), parents)


def overlap(a: list[FloatArray], b: list[FloatArray]) -> float:
    """Return the common part of two regions as a fraction of the smaller one.

    Parameters
    ----------
    a, b : lists of (k, 2) arrays
        Closed polygons; inside is what an odd number of them encloses.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    >>> round(overlap([square], [square + [1.0, 0.0]]), 2)
    0.75
    """
    boxes = [
        (np.min([p.min(axis=0) for p in r], axis=0), np.max([p.max(axis=0) for p in r], axis=0))
        for r in (a, b)
    ]
    if (boxes[0][0] > boxes[1][1]).any() or (boxes[1][0] > boxes[0][1]).any():
        return 0.0
    counts = []
    for own, other, (low, high) in ((a, b, boxes[0]), (b, a, boxes[1])):
        x, y = _nodes(low, high)
        mine = _inside(x, y, own)
        area = float(mine.mean() * np.prod(high - low))
        shared = float((mine & _inside(x, y, other)).sum() / max(int(mine.sum()), 1))
        counts.append((area, shared))
    return min(counts)[1]


def share_outside(a: list[FloatArray], others: list[FloatArray]) -> float:
    """Return the fraction of region `a` that lies in none of the other polygons."""
    low, high = np.min([p.min(axis=0) for p in a], axis=0), np.max([p.max(axis=0) for p in a], axis=0)
    x, y = _nodes(low, high)
    mine = _inside(x, y, a)
    return float((mine & ~_inside(x, y, others)).sum() / max(int(mine.sum()), 1))


def _nodes(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    t = (np.arange(GRID) + 0.5) / GRID
    x, y = low[:, None] + t * (high - low)[:, None]
    return x, y


def _inside(x: FloatArray, y: FloatArray, polygons: list[FloatArray]) -> BoolArray:
    if not polygons:
        return np.zeros((len(y), len(x)), dtype=bool)
    start = np.concatenate(polygons)
    end = np.concatenate([np.roll(p, -1, axis=0) for p in polygons])
    return inside_grid(x, y, start, end)
