r"""Sections of any topology as tubes: runs of loops that go on one to one, and the joints between them.

::

     tube   tube
      | |   | |
      | |   | |      joint: the tubes above and below
     --+=====+--     share edges in one plane
      |       |
        tube
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import PchipInterpolator

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.sectioning.level_changes import (
    Joined,
    Straight,
    joint_of,
    levels_between,
    narrows,
    steps_between,
)
from stackloft.sectioning.levels import Level, covered, is_hole, part_level, plain_level
from stackloft.sectioning.line_parting import Parting, parting_levels
from stackloft.sectioning.loop_links import LinkedLoops, link_loops
from stackloft.sectioning.section_regions import Regions, section_regions
from stackloft.sectioning.sections_between import between
from stackloft.sectioning.tube_rows import JointUse, Row, TubeOfLoops, level_rows, part_row, pinned_row

FILLING = (0.25, 0.5, 0.75)
"""Where levels are put in between loops that differ too much to be joined at once."""


@dataclass(frozen=True, slots=True, eq=False)
class TubeSet:
    """A body as tubes and joints."""

    tubes: tuple[TubeOfLoops, ...]
    joints: tuple[tuple[FloatArray, ...], ...]
    """Each joint's edges, (k, 3) mm"""
    notices: tuple[Notice, ...]


class _Builder:
    """Tubes while levels are added from the first to the last."""

    def __init__(self, levels: list[Level], filled: frozenset[int]) -> None:
        self.filled = filled
        real = [level for level in levels if level.section is not None]
        z = [level.z for level in real]
        areas = [covered(level) for level in real]
        self._real = real
        self._areas = PchipInterpolator(z, areas) if len(z) > 1 else None
        self.done: list[TubeOfLoops] = []
        self.joints: list[tuple[FloatArray, ...]] = []
        self.notices: list[Notice] = []

    def area(self, z: float) -> float:
        """Return the area of all loops at z, mm², from the sections' areas."""
        return float(self._areas(z)) if self._areas is not None else 0.0

    def from_section(self, level: Level, *, away_from: Level) -> tuple[Level, ...]:
        """Return the section of a level, whole, and those beyond it as seen from another level."""
        outwards = self._real if level.z > away_from.z else self._real[::-1]
        return tuple(other for other in outwards if (other.z - level.z) * (level.z - away_from.z) >= 0.0)

    def begin(self, row: Row, end: JointUse | float) -> TubeOfLoops:
        return TubeOfLoops([row], [end])

    def finish(self, tube: TubeOfLoops, end: JointUse | float) -> None:
        tube.ends.append(end)
        self.done.append(tube)


def trace_tubes(levels: list[Level], filled: frozenset[int] = frozenset()) -> TubeSet:
    """Return the tubes of a stack of levels.

    Parameters
    ----------
    levels : list of Level
        In order along the axis.
    filled : frozenset of int
        Sections after which levels are put in even where loops go on one to one.

    Raises
    ------
    InputError
        Neighbouring levels cannot be linked.
    """
    builder = _Builder(levels, filled)
    rows = level_rows(levels[0])
    open_tubes = [builder.begin(row, np.inf) for row in rows]
    for before, after in pairwise(levels):
        open_tubes = _advance(builder, before, after, open_tubes)
    for tube in open_tubes:
        builder.finish(tube, np.inf)
    return TubeSet(tuple(builder.done), tuple(builder.joints), tuple(builder.notices))


def _regions(level: Level) -> Regions:
    return section_regions(list(level.polygons), level.name)


def _advance(builder: _Builder, before: Level, after: Level, tubes: list[TubeOfLoops]) -> list[TubeOfLoops]:
    """Lead all tubes from one level to the next; returns those open there, one a loop."""
    found: list[TubeOfLoops | None] = [None] * len(after.loops)
    rows = level_rows(after)
    gap = after.z - before.z
    for linked in link_loops(_regions(before), _regions(after)):
        if linked.weak:
            builder.notices.append(_weak(before, after))
        if linked.plain:
            i, j = linked.before[0], linked.after[0]
            if before.section in builder.filled:
                tubes[i].rows += _filling(builder, before, after, i, j)
            tubes[i].rows.append(rows[j])
            found[j] = tubes[i]
        elif not linked.after:
            for i in linked.before:
                builder.finish(tubes[i], gap)
        elif not linked.before:
            for j in linked.after:
                found[j] = builder.begin(rows[j], gap)
        else:
            _change(builder, before, after, linked, tubes, found)
    return [tube for tube in found if tube is not None]


def _filling(builder: _Builder, before: Level, after: Level, i: int, j: int) -> list[Row]:
    """Return rows between a loop and its follower, of shapes in between."""
    one, two = part_level(before, (i,)), part_level(after, (j,))
    field = between(list(one.polygons), list(two.polygons), _part_area(builder, before, after, one, two))
    rows = []
    for t in FILLING:
        loops = field.at(t)
        if len(loops) != 1:
            return []
        z = one.z + t * (two.z - one.z)
        rows += level_rows(plain_level(z, loops, f"between {one.name} and {two.name}"))
    return rows


def _weak(before: Level, after: Level) -> Notice:
    return Notice(
        "weak-link",
        f"{before.name} to {after.name}: loops that overlap by less than 30 % of the smaller one were taken"
        " for one part of the body: cut thinner slices",
    )


def _change(
    builder: _Builder,
    before: Level,
    after: Level,
    linked: LinkedLoops,
    tubes: list[TubeOfLoops],
    found: list[TubeOfLoops | None],
) -> None:
    """Lead the tubes through a gap in which they split, merge, or close round a hole."""
    one, two = part_level(before, linked.before), part_level(after, linked.after)
    open_tubes = [tubes[i] for i in linked.before]
    if before.section is not None and after.section is not None:  # else they were put in already
        put_in = levels_between(one, two, _part_area(builder, before, after, one, two))
        trial = steps_between(one, put_in, two)
    else:
        put_in, trial = [], [joint_of(one, two)]
    if any(t is None for t in trial) or (put_in and not narrows(trial, joint_of(one, two))):
        put_in, trial = _along_a_line(builder, one, two)
    if trial[0] is None and not put_in:
        raise InputError(
            "neighbouring sections cannot be linked: loops part and meet between them in more ways than one",
            where=f"{before.name} to {after.name}",
            found=f"{len(linked.before)} loops, then {len(linked.after)}",
            fix="cut thinner slices there, or use --method shape-interpolation or cavalieri",
        )
    levels = [one, *put_in, two]
    for low, high, step in zip(levels[:-1], levels[1:], trial, strict=True):
        open_tubes = _step(builder, low, high, step, open_tubes)
    for j, tube in zip(linked.after, open_tubes, strict=True):
        found[j] = tube


def _along_a_line(
    builder: _Builder, one: Level, two: Level
) -> tuple[list[Level], list[Straight | Joined | None]]:
    """Return levels put in where a piece parts along a line, none where it does not, and how they follow."""
    direct: tuple[list[Level], list[Straight | Joined | None]] = ([], [joint_of(one, two)])
    whole, parted = sorted((one, two), key=lambda level: len(level.loops))
    if len(whole.loops) != 1 or len({is_hole(p) for p in (*whole.polygons, *parted.polygons)}) != 1:
        return direct
    put_in = parting_levels(Parting(whole, parted, builder.from_section(parted, away_from=whole)))
    if whole is two:
        put_in = put_in[::-1]
    trial = steps_between(one, put_in, two)
    return (put_in, trial) if all(t is not None for t in trial) else direct


def _part_area(
    builder: _Builder, before: Level, after: Level, one: Level, two: Level
) -> Callable[[float], float]:
    """Return the area of the loops that change, mm², at t in [0, 1] between two sections.

    What all sections' areas say, less the other loops' share.
    """
    ends = covered(one), covered(two)
    others = covered(before) - ends[0], covered(after) - ends[1]
    sign = 1.0 if ends[0] + ends[1] > 0.0 else -1.0
    low, high = sorted(sign * end for end in ends)

    def area(t: float) -> float:
        whole = builder.area(one.z + t * (two.z - one.z))
        own = sign * (whole - (1.0 - t) * others[0] - t * others[1])
        return min(max(own, 0.7 * low), 1.4 * high)

    return area


def _step(
    builder: _Builder, low: Level, high: Level, step: Straight | Joined | None, tubes: list[TubeOfLoops]
) -> list[TubeOfLoops]:
    """Lead tubes from one level to the next as decided; returns them in the order of the upper loops."""
    assert step is not None
    rows = level_rows(high)
    if isinstance(step, Straight):
        following = [tubes[i] for i in step.order]
        for tube, row in zip(following, rows, strict=True):
            tube.rows.append(row)
        return following
    joined = low if step.upward else high
    number = len(builder.joints)
    builder.joints.append(tuple(np.column_stack([e, np.full(len(e), joined.z)]) for e in step.cut.edges))
    if step.upward:
        for tube, whole in zip(tubes, step.cut.wholes, strict=True):
            tube.rows[-1] = pinned_row(tube.rows[-1], whole)
            builder.finish(tube, JointUse(number, whole.edges))
        following = []
        for part_number, row in zip(step.order, rows, strict=True):
            part = step.cut.parts[part_number]
            tube = builder.begin(part_row(part, joined, row.hole), JointUse(number, part.edges))
            tube.rows.append(row)
            following.append(tube)
        return following
    for part_number, tube in zip(step.order, tubes, strict=True):
        part = step.cut.parts[part_number]
        tube.rows.append(part_row(part, joined, tube.hole))
        builder.finish(tube, JointUse(number, part.edges))
    return [
        builder.begin(pinned_row(row, whole), JointUse(number, whole.edges))
        for row, whole in zip(rows, step.cut.wholes, strict=True)
    ]
