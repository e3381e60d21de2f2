"""How the loops of one level become those of the next where the topology changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stackloft.geometry.bridge_cut import cut_bridges
from stackloft.geometry.bridge_edges import BridgeCut
from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.sectioning.change_of_topology import change_levels
from stackloft.sectioning.levels import Level, is_hole, loop_counts, put_in_level
from stackloft.sectioning.section_regions import overlap
from stackloft.sectioning.sections_between import between

NARROWER = 0.3
"""A bridge near the change of topology is shorter than this fraction of the one on the section."""

SAME = 1e-6
"""Lengths that differ by this fraction are of one bridge, cut on vertices that were rounded differently."""


def narrows(trial: list[Straight | Joined | None], direct: Straight | Joined | None) -> bool:
    """Return whether the bridges are shorter near the change than on the section itself.

    A body that parts along a whole line at once keeps its bridge, and the interpolation is noise there.
    """
    if not isinstance(direct, Joined):
        return True
    lengths = [bridge_length(step.cut) for step in trial if isinstance(step, Joined)]
    whole = bridge_length(direct.cut)
    if np.isclose(lengths, whole, rtol=SAME).any():  # the section itself lies next to the change
        whole = max(np.sqrt(abs(polygon_area(w.points))) for w in direct.cut.wholes)
    return max(lengths, default=0.0) < NARROWER * whole


def bridge_length(cut: BridgeCut) -> float:
    """Return the length of the longest chord, mm."""
    arcs = sum(len(whole.edges) for whole in cut.wholes)
    return max((float(np.linalg.norm(edge[-1] - edge[0])) for edge in cut.edges[arcs:]), default=0.0)


@dataclass(frozen=True, slots=True, eq=False)
class Straight:
    """Every loop goes on as one loop: after[k] follows before[order[k]]."""

    order: tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Joined:
    """Loops of one level cut into those of the other."""

    cut: BridgeCut
    upward: bool
    """True when the lower level's loops are cut."""
    order: tuple[int, ...]
    """The part that each loop of the other level follows."""


def levels_between(one: Level, two: Level, area: Callable[[float], float]) -> list[Level]:
    """Return levels put in about the changes of topology."""
    field = between(list(one.polygons), list(two.polygons), two.z - one.z, area)
    name = f"between {one.name} and {two.name}"
    return [
        put_in_level(one.z + t * (two.z - one.z), loops, name)
        for t, loops in change_levels(field, cornered=cornered(one, two))
    ]


def cornered(*levels: Level) -> bool:
    """Return whether any loop of the levels has a corner."""
    return any(len(loop.corners) for level in levels for loop in level.loops)


def steps_between(one: Level, put_in: list[Level], two: Level) -> list[Straight | Joined | None]:
    """Return how each level leads to the next."""
    levels = [one, *put_in, two]
    return [joint_of(low, high) for low, high in pairwise(levels)]


def joint_of(low: Level, high: Level) -> Straight | Joined | None:
    """Return how a level's loops lead to the next one's; None when they do not."""
    counts = [loop_counts(level) for level in (low, high)]
    if counts[0] == counts[1]:
        order = matched(list(low.polygons), list(high.polygons))
        return None if order is None else Straight(order)
    upward = np.subtract(*counts[0]) < np.subtract(*counts[1])
    joined, parted = (low, high) if upward else (high, low)
    (outer_j, hole_j), (outer_p, hole_p) = loop_counts(joined), loop_counts(parted)
    if outer_p < outer_j or hole_p > hole_j:
        return None
    cut = cut_bridges(list(joined.polygons), list(parted.polygons), outer_p - outer_j, hole_j - hole_p)
    if cut is None:
        return None
    order = matched([part.points for part in cut.parts], list(parted.polygons))
    return None if order is None else Joined(cut, upward, order)


def matched(before: list[FloatArray], after: list[FloatArray]) -> tuple[int, ...] | None:
    """Return for each loop of `after` the one of `before` that it follows; None unless one to one."""
    if len(before) != len(after):
        return None
    share = np.array(
        [[overlap([a], [b]) if is_hole(a) == is_hole(b) else 0.0 for a in before] for b in after]
    )
    order = [-1] * len(after)
    for _ in after:
        j, i = np.unravel_index(int(np.argmax(share)), share.shape)
        if share[j, i] <= 0.0:
            return None
        order[int(j)] = int(i)
        share[j, :] = share[:, i] = -1.0
    return tuple(order)
