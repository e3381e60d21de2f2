"""Which loops bound holes: the even–odd rule.

::

    +-----------------+
    |   +--------+    |     depth 0: outline
    |   | hole   |    |     depth 1: hole
    |   |  +--+  |    |     depth 2: an island in it, an outline again
    |   |  +--+  |    |
    |   +--------+    |
    +-----------------+
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.polygon_distance import signed_distance_at
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError

TOUCHING = 1e-3
"""Loops that overstep each other by less than this fraction of the longer side of one's box touch: where a
body all but parts, curves through two tips overstep each other by what lies between two points of a loop."""
_CHUNK = 2_000_000  # point–edge pairs tested at a time


def enclosing_loops(loops: Sequence[FloatArray], name: str = "") -> list[list[int]]:
    """Return, for each loop, the numbers of the loops that enclose it.

    Parameters
    ----------
    loops : sequence of ndarray, (k, 2)
        Closed polygons, the last vertex joined to the first, in either direction.
    name : str
        Section label, for the message.

    Raises
    ------
    InputError
        Two loops cross: one has vertices on both sides of the other.

    Examples
    --------
    >>> square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    >>> enclosing_loops([4 * square, 2 * square, square])
    [[], [0], [0, 1]]
    """
    boxes = [(loop.min(axis=0), loop.max(axis=0)) for loop in loops]
    found: list[list[int]] = [[] for _ in loops]
    for inner, (low, high) in enumerate(boxes):
        for outer, (outer_low, outer_high) in enumerate(boxes):
            if inner == outer or (high < outer_low).any() or (low > outer_high).any():
                continue
            within = inside_polygon(loops[inner], loops[outer])
            if within.any() and not within.all():
                within = within[_clear(loops[inner], loops[outer])]
            if not len(within):
                raise _crossing(name, inner, outer)
            if within.all() and not _same_or_larger(low, high, outer_low, outer_high):
                found[inner].append(outer)
            elif within.any() and not within.all():
                raise _crossing(name, inner, outer)
    return found


def _clear(points: FloatArray, polygon: FloatArray) -> NDArray[np.bool_]:
    """Return whether each point lies clear of a polygon's line, which loops that touch may overstep."""
    return np.abs(signed_distance_at(points, [polygon])) > TOUCHING * float(np.ptp(polygon, axis=0).max())


def _crossing(name: str, one: int, other: int) -> InputError:
    return InputError(
        "loops cross each other",
        where=name or None,
        found=f"loops {one + 1} and {other + 1}",
        expected="loops that lie apart or one within the other",
    )


def nesting_depths(loops: Sequence[FloatArray], name: str = "") -> list[int]:
    """Return how many loops enclose each loop: even for outlines, odd for holes.

    Examples
    --------
    >>> square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    >>> nesting_depths([square, square + 5, 2 * square])
    [1, 0, 0]
    """
    return [len(enclosing) for enclosing in enclosing_loops(loops, name)]


def inside_polygon(points: FloatArray, polygon: FloatArray) -> NDArray[np.bool_]:
    """Return whether each point lies inside a polygon: an odd number of edges to its right.

    Parameters
    ----------
    points : ndarray, (n, 2)
    polygon : ndarray, (k, 2)

    Examples
    --------
    >>> inside_polygon(np.array([[0.2, 0.2], [2.0, 0.2]]), np.array([[0.0, 0], [1, 0], [0, 1]]))
    array([ True, False])
    """
    chunk = max(1, _CHUNK // len(polygon))
    parts = [_inside(points[start : start + chunk], polygon) for start in range(0, len(points), chunk)]
    return np.concatenate(parts)


def _inside(points: FloatArray, polygon: FloatArray) -> NDArray[np.bool_]:
    x, y = points[:, 0, None], points[:, 1, None]
    x0, y0 = polygon.T
    x1, y1 = np.roll(polygon, -1, axis=0).T
    spans = (y0 > y) != (y1 > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossed = x < x0 + (y - y0) * (x1 - x0) / (y1 - y0)
    return np.asarray(np.count_nonzero(spans & crossed, axis=1) % 2 == 1)


def _same_or_larger(low: FloatArray, high: FloatArray, other_low: FloatArray, other_high: FloatArray) -> bool:
    """Return True for a box that encloses another: points on its edges may count as inside."""
    return bool((low <= other_low).all() and (high >= other_high).all())
