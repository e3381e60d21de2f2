r"""Limbs that lie: slender parts of an outline that are there at once on one section and not on the next.

::

      .----.________________
     (      ________________)     the section with the limb, cut off at its root
      `----´
      .----.
     (      )                     the section without it
      `----´

A skin would have to draw all of the limb's outline out of the short stretch at its root, and its columns
slip. The limb is a tube of its own instead, which ends between the sections; the cut across its root is a
joint.
"""

from __future__ import annotations

import numpy as np

from stackloft.geometry.bridge_cut import cut_off
from stackloft.geometry.polygon_distance import signed_distance_at
from stackloft.geometry.shoelace import polygon_area, polygon_perimeter
from stackloft.geometry.simple_polygon import crosses_itself
from stackloft.model.arrays import BoolArray, FloatArray
from stackloft.sectioning.level_changes import Joined
from stackloft.sectioning.levels import Level, is_hole

SLENDER = 5.0
"""Outline of a limb, in widths of its root, at least: it is more than two widths long."""
ROOTS = (0.01, 0.02, 0.04)
"""How far outside the other section's loop a limb's root is looked for, in lengths of that loop."""
WIDER = 1.3
"""Mean width of a limb, in widths of its root, at most: what is broad beyond a narrow root is the body."""
LEFT = 0.8
"""What is left without limbs has at least this part of the other section's area."""
LONGER = 0.04
"""A loop is longer than its neighbour by at least this part of its length when it has grown a limb."""


def limbs_cut_off(low: Level, high: Level) -> Joined | None:
    """Return how one loop goes on as one when limbs of either are cut off; None when there are none.

    Parameters
    ----------
    low, high : Level
        One loop each.
    """
    upward = polygon_perimeter(low.polygons[0]) > polygon_perimeter(high.polygons[0])
    longer, other = (level.polygons[0] for level in ((low, high) if upward else (high, low)))
    if is_hole(longer) or not _may_have_limbs(longer, other):
        return None
    runs = _limbs(longer, other)
    if not runs:
        return None
    cut = cut_off(longer, runs)
    *limbs, rest = (part.points for part in cut.parts)
    if polygon_area(rest) < LEFT * polygon_area(other) or not all(_is_straight(limb) for limb in limbs):
        return None
    if any(crosses_itself(part.points[None])[0] for part in cut.parts):  # a root across a bay
        return None
    return Joined(cut, upward, (len(runs),))


def _is_straight(limb: FloatArray) -> bool:
    """Return whether a part is hardly wider farther out than its root, from its last vertex to its first."""
    root = float(np.linalg.norm(limb[0] - limb[-1]))
    return polygon_area(limb) < WIDER * root * 0.5 * (polygon_perimeter(limb) - root)


def _may_have_limbs(longer: FloatArray, other: FloatArray) -> bool:
    """Return whether a loop has become longer by more than a stout part with as much area would make it."""
    length = polygon_perimeter(longer)
    more = 0.5 * (length - polygon_perimeter(other))
    return 2.0 * more > LONGER * length and more**2 > abs(polygon_area(longer) - polygon_area(other))


def _limbs(points: FloatArray, other: FloatArray) -> list[tuple[int, int]]:
    """Return the first and last vertex of every limb: a long run far outside, with a short chord."""
    beyond = -signed_distance_at(points, [other])
    side = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    length = polygon_perimeter(other)
    for root in ROOTS:
        found = []
        for first, last in _runs(beyond > root * length):
            run = np.arange(first, last) % len(points)
            chord = float(np.linalg.norm(points[last % len(points)] - points[first]))
            if side[run].sum() > SLENDER * max(chord, float(side.mean())):
                found.append((first, last % len(points)))
        if found:
            return found
    return []


def _runs(chosen: BoolArray) -> list[tuple[int, int]]:
    """Return (first, last) of every run round the loop, last above first; none where all or none is."""
    starts = np.flatnonzero(chosen & ~np.roll(chosen, 1))
    stops = np.flatnonzero(chosen & ~np.roll(chosen, -1))
    runs = []
    for first in starts.tolist():
        last = int(stops[np.argmin((stops - first) % len(chosen))])
        runs.append((first, last if last >= first else last + len(chosen)))
    return [(first, last) for first, last in runs if last > first + 1]
