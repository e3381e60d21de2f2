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

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from types import MappingProxyType

import numpy as np

from stackloft.geometry.bridge_edges import Part
from stackloft.model.arrays import FloatArray
from stackloft.model.notices import Notice
from stackloft.sectioning.level_changes import Joined, Straight, cornered
from stackloft.sectioning.levels import Level, part_level, put_in_level
from stackloft.sectioning.loop_numbers import Links
from stackloft.sectioning.mends import STRAIGHT, Mends
from stackloft.sectioning.sections_between import between
from stackloft.sectioning.tube_links import Change, LinkFinder
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
    limbs: frozenset[int]
    """Sections after which a lying limb could be cut off, cut or not."""


class _Builder:
    """Tubes while levels are added from the first to the last."""

    def __init__(self, levels: list[Level], mended: Mends, links: Mapping[str, Links]) -> None:
        self.filled = mended.filled
        self.finder = LinkFinder(levels, links, mended.limbs)
        self.done: list[TubeOfLoops] = []
        self.joints: list[tuple[FloatArray, ...]] = []

    def begin(self, row: Row, end: JointUse | float) -> TubeOfLoops:
        return TubeOfLoops([row], [end])

    def finish(self, tube: TubeOfLoops, end: JointUse | float) -> None:
        tube.ends.append(end)
        self.done.append(tube)


def trace_tubes(
    levels: list[Level],
    mended: Mends = STRAIGHT,
    links: Mapping[str, Links] = MappingProxyType({}),
) -> TubeSet:
    """Return the tubes of a stack of levels.

    Parameters
    ----------
    levels : list of Level
        In order along the axis.
    mended : Mends
        What is done after which sections where a straight skin would fold or slip.
    links : mapping of str to pairs
        By the name of a section: links to the next one that are not to be sought, as `numbered_links`.

    Raises
    ------
    InputError
        Neighbouring levels cannot be linked.
    """
    builder = _Builder(levels, mended, links)
    rows = level_rows(levels[0])
    open_tubes = [builder.begin(row, np.inf) for row in rows]
    for before, after in pairwise(levels):
        open_tubes = _advance(builder, before, after, open_tubes)
    for tube in open_tubes:
        builder.finish(tube, np.inf)
    finder = builder.finder
    return TubeSet(tuple(builder.done), tuple(builder.joints), tuple(finder.notices), frozenset(finder.limbs))


def _advance(builder: _Builder, before: Level, after: Level, tubes: list[TubeOfLoops]) -> list[TubeOfLoops]:
    """Lead all tubes from one level to the next; returns those open there, one a loop."""
    found: list[TubeOfLoops | None] = [None] * len(after.loops)
    rows = level_rows(after)
    gap = after.z - before.z
    for linked, change in builder.finder.links(before, after):
        if change is not None:
            _lead(builder, change, tubes, found)
        elif linked.plain:
            i, j = linked.before[0], linked.after[0]
            if before.section in builder.filled:
                tubes[i].rows += _filling(builder, before, after, i, j)
            tubes[i].rows.append(rows[j])
            found[j] = tubes[i]
        elif not linked.after:
            for i in linked.before:
                builder.finish(tubes[i], gap)
        else:
            for j in linked.after:
                found[j] = builder.begin(rows[j], gap)
    return [tube for tube in found if tube is not None]


def _filling(builder: _Builder, before: Level, after: Level, i: int, j: int) -> list[Row]:
    """Return rows between a loop and its follower, of shapes in between."""
    one, two = part_level(before, (i,)), part_level(after, (j,))
    field = between(
        list(one.polygons),
        list(two.polygons),
        two.z - one.z,
        builder.finder.part_area(before, after, one, two),
    )
    rows = []
    for t in FILLING:
        loops = field.loops_at(t, cornered=cornered(one, two))
        if len(loops) != 1:
            return []
        z = one.z + t * (two.z - one.z)
        rows += level_rows(put_in_level(z, loops, f"between {one.name} and {two.name}"))
    return rows


def _lead(
    builder: _Builder,
    change: Change,
    tubes: list[TubeOfLoops],
    found: list[TubeOfLoops | None],
) -> None:
    """Lead the tubes through a change."""
    open_tubes = [tubes[i] for i in change.linked.before]
    for (low, high), step in zip(pairwise(change.levels), change.steps, strict=True):
        open_tubes = _step(builder, low, high, step, open_tubes)
    for j, tube in zip(change.linked.after, open_tubes, strict=True):
        found[j] = tube


def _step(
    builder: _Builder, low: Level, high: Level, step: Straight | Joined, tubes: list[TubeOfLoops]
) -> list[TubeOfLoops]:
    """Lead tubes from one level to the next as decided; returns them in the order of the upper loops."""
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
        for part in _ending(step):
            limb = builder.begin(part_row(part, joined, hole=False), JointUse(number, part.edges))
            builder.finish(limb, high.z - low.z)
        return following
    for part_number, tube in zip(step.order, tubes, strict=True):
        part = step.cut.parts[part_number]
        tube.rows.append(part_row(part, joined, tube.hole))
        builder.finish(tube, JointUse(number, part.edges))
    for part in _ending(step):
        limb = builder.begin(part_row(part, joined, hole=False), high.z - low.z)
        builder.finish(limb, JointUse(number, part.edges))
    return [
        builder.begin(pinned_row(row, whole), JointUse(number, whole.edges))
        for row, whole in zip(rows, step.cut.wholes, strict=True)
    ]


def _ending(step: Joined) -> list[Part]:
    """Return the parts that no loop of the other level follows: limbs, which end before it."""
    return [part for k, part in enumerate(step.cut.parts) if k not in step.order]
