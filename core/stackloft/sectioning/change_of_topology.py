"""Where between two sections the topology changes, and the levels that are put in about it."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.simple_polygon import crosses_itself
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.sections_between import BetweenField, topology

CLOSEST = 1.0 / 256.0
"""How closely, in pitches, the change of topology is bracketed."""
GRADES = (0.25, 1.0 / 16.0, 1.0 / 64.0)
"""Distances from the change, as fractions of the way to the given section, at which sections are put in."""
FINEST = 0.25
"""Levels are put in no closer to the change than this many grid steps."""
NEAR = 0.1
"""Part of the pitch within which a section stands for the levels about the change."""
HAIR = 0.05
"""Part of the pitch within which no level is put in beside a section beyond the change."""


def change_levels(field: BetweenField, *, cornered: bool) -> list[tuple[float, list[Loop]]]:
    """Return (t, loops) of levels about the change of topology between t = 0 and t = 1, increasing in t.

    The last t with the first section's topology and the first t with the second's are found to `CLOSEST`;
    what lies between them is the interpolation's noise or several changes close together.
    """
    low, high = _reach(field, 0.0, 1.0), _reach(field, 1.0, 0.0)
    if low >= high or (low, high) == (0.0, 1.0):
        return []
    sides = dict(zip((0.0, 1.0), field.sides, strict=True))
    # Columns through rows a hair apart take their direction from the noise: of the two levels about the
    # change only the one that is cut is kept, and a section next to the change stands for it.
    cut_first = bool(np.subtract(*sides[0.0]) < np.subtract(*sides[1.0]))
    change, room = (low, low) if cut_first else (high, 1.0 - high)
    finest = FINEST * float(field.x[1] - field.x[0]) / field.pitch
    below = [(low * (1.0 - g), 0.0) for g in GRADES if low * g >= finest]
    about = [] if room < NEAR else [(change, 0.0 if cut_first else 1.0)]
    above = [(high + (1.0 - high) * g, 1.0) for g in reversed(GRADES) if (1.0 - high) * g >= finest]
    wanted = [(t, side) for t, side in (*below, *about, *above) if abs(1.0 - side - t) >= HAIR]
    levels = [(t, field.loops_at(t, cornered=cornered), side) for t, side in wanted]
    return [(t, loops) for t, loops, side in levels if _has_topology(loops, sides[side])]


def _has_topology(loops: list[Loop], wanted: tuple[int, int]) -> bool:
    """Return whether there are as many outlines and holes, none crossing itself at too narrow a waist."""
    every = [loop.points for loop in loops]
    return topology(every) == wanted and not any(crosses_itself(points[None])[0] for points in every)


def _reach(field: BetweenField, start: float, stop: float) -> float:
    """Return how far from `start` towards `stop` the topology of the section at `start` lasts."""
    now = field.sides[int(start)]
    if topology(field.at(start)) != now:
        return start
    while abs(stop - start) > CLOSEST:
        middle = 0.5 * (start + stop)
        if topology(field.at(middle)) == now:
            start = middle
        else:
            stop = middle
    return start
