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
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.interpolate import PchipInterpolator

from stackloft.geometry.bridge_cut import BridgeCut, Part, cut_bridges
from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.model.contour_stack import Loop
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.sectioning.loop_links import LinkedLoops, link_loops
from stackloft.sectioning.section_regions import Regions, overlap, section_regions
from stackloft.sectioning.sections_between import between, change_levels

SHORT_CHORD = 0.02
"""A cut shorter than this fraction of the loop is drawn as one corner."""


FILLING = (0.25, 0.5, 0.75)
"""Where levels are put in between loops that differ too much to be joined at once."""
NARROWER = 0.3
"""A bridge near the change of topology is shorter than this fraction of the one on the section."""


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """The loops at one position."""

    z: float
    """mm"""
    loops: tuple[Loop, ...]
    """outlines counter-clockwise, holes clockwise"""
    polygons: tuple[FloatArray, ...]
    """the same in short sides, same directions"""
    name: str
    section: int | None
    """Number of the section; None for one put in."""


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
        areas = [_covered(level) for level in real]
        self._areas = PchipInterpolator(z, areas) if len(z) > 1 else None
        self.done: list[TubeOfLoops] = []
        self.joints: list[tuple[FloatArray, ...]] = []
        self.notices: list[Notice] = []

    def area(self, z: float) -> float:
        """Return the area of all loops at z, mm², from the sections' areas."""
        return float(self._areas(z)) if self._areas is not None else 0.0

    def begin(self, row: Row, end: JointUse | float) -> TubeOfLoops:
        return TubeOfLoops([row], [end])

    def finish(self, tube: TubeOfLoops, end: JointUse | float) -> None:
        tube.ends.append(end)
        self.done.append(tube)


def make_level(
    z: float, loops: list[Loop], polygons: list[FloatArray], name: str, section: int | None
) -> Level:
    """Return a level whose outlines run counter-clockwise and whose holes run clockwise.

    Raises
    ------
    InputError
        Loops cross.
    """
    regions = section_regions(polygons, name)
    turned = [
        (loop, p) if (_area(p) < 0.0) == bool(hole) else (_reversed(loop), p[::-1])
        for loop, p, hole in zip(loops, polygons, regions.holes, strict=True)
    ]
    return Level(z, tuple(t[0] for t in turned), tuple(t[1] for t in turned), name, section)


def _reversed(loop: Loop) -> Loop:
    return Loop(loop.points[::-1], np.sort(len(loop.points) - 1 - loop.corners), loop.hole)


def is_hole(polygon: FloatArray) -> bool:
    """Return whether a level's polygon bounds a hole: it runs clockwise."""
    return _area(polygon) < 0.0


def _area(points: FloatArray) -> float:
    x, y = (points - points[0]).T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


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
    rows = _rows(levels[0])
    open_tubes = [builder.begin(row, np.inf) for row in rows]
    for before, after in pairwise(levels):
        open_tubes = _advance(builder, before, after, open_tubes)
    for tube in open_tubes:
        builder.finish(tube, np.inf)
    return TubeSet(tuple(builder.done), tuple(builder.joints), tuple(builder.notices))


def _rows(level: Level) -> list[Row]:
    return [
        Row(level.z, loop, level.name, level.section, _area(p) < 0.0)
        for loop, p in zip(level.loops, level.polygons, strict=True)
    ]


def _regions(level: Level) -> Regions:
    return section_regions(list(level.polygons), level.name)


def _advance(builder: _Builder, before: Level, after: Level, tubes: list[TubeOfLoops]) -> list[TubeOfLoops]:
    """Lead all tubes from one level to the next; returns those open there, one a loop."""
    found: list[TubeOfLoops | None] = [None] * len(after.loops)
    rows = _rows(after)
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
    one, two = _part_level(before, (i,)), _part_level(after, (j,))
    field = between(list(one.polygons), list(two.polygons), _part_area(builder, before, after, one, two))
    rows = []
    for t in FILLING:
        loops = field.at(t)
        if len(loops) != 1:
            return []
        z = one.z + t * (two.z - one.z)
        rows += _rows(_plain_level(z, loops, f"between {one.name} and {two.name}"))
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
    one, two = _part_level(before, linked.before), _part_level(after, linked.after)
    open_tubes = [tubes[i] for i in linked.before]
    if before.section is not None and after.section is not None:  # else they were put in already
        put_in = _levels_between(one, two, _part_area(builder, before, after, one, two))
        trial = _trial(one, put_in, two)
    else:
        put_in, trial = [], [_joint(one, two)]
    if any(t is None for t in trial) or (put_in and not _narrows(trial, _joint(one, two))):
        put_in, trial = [], [_joint(one, two)]
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


def _narrows(trial: list[_Straight | _Joined | None], direct: _Straight | _Joined | None) -> bool:
    """Return whether the bridges are shorter near the change than on the section itself.

    A body that parts along a whole line at once keeps its bridge, and the interpolation is noise there.
    """
    if not isinstance(direct, _Joined):
        return True
    cuts = [step.cut for step in trial if isinstance(step, _Joined)]
    return max((_bridge(cut) for cut in cuts), default=0.0) < NARROWER * _bridge(direct.cut)


def _bridge(cut: BridgeCut) -> float:
    """Return the length of the longest chord, mm."""
    arcs = sum(len(whole.edges) for whole in cut.wholes)
    return max((float(np.linalg.norm(edge[-1] - edge[0])) for edge in cut.edges[arcs:]), default=0.0)


def _part_level(level: Level, chosen: tuple[int, ...]) -> Level:
    return Level(
        level.z,
        tuple(level.loops[k] for k in chosen),
        tuple(level.polygons[k] for k in chosen),
        level.name,
        level.section,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Straight:
    """Every loop goes on as one loop: after[k] follows before[order[k]]."""

    order: tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False)
class _Joined:
    """Loops of one level cut into those of the other."""

    cut: BridgeCut
    upward: bool
    """True when the lower level's loops are cut."""
    order: tuple[int, ...]
    """The part that each loop of the other level follows."""


def _covered(level: Level) -> float:
    """Return the area of a level's loops, holes subtracted, mm²."""
    return float(sum(_area(p) for p in level.polygons))


def _part_area(
    builder: _Builder, before: Level, after: Level, one: Level, two: Level
) -> Callable[[float], float]:
    """Return the area of the loops that change, mm², at t in [0, 1] between two sections.

    What all sections' areas say, less the other loops' share.
    """
    ends = _covered(one), _covered(two)
    others = _covered(before) - ends[0], _covered(after) - ends[1]
    sign = 1.0 if ends[0] + ends[1] > 0.0 else -1.0
    low, high = sorted(sign * end for end in ends)

    def area(t: float) -> float:
        whole = builder.area(one.z + t * (two.z - one.z))
        own = sign * (whole - (1.0 - t) * others[0] - t * others[1])
        return min(max(own, 0.7 * low), 1.4 * high)

    return area


def _levels_between(one: Level, two: Level, area: Callable[[float], float]) -> list[Level]:
    """Return levels put in about the changes of topology."""
    field = between(list(one.polygons), list(two.polygons), area)
    name = f"between {one.name} and {two.name}"
    return [_plain_level(one.z + t * (two.z - one.z), loops, name) for t, loops in change_levels(field)]


def _plain_level(z: float, loops: list[FloatArray], name: str) -> Level:
    return Level(z, tuple(Loop(p) for p in loops), tuple(loops), name, None)


def _trial(one: Level, put_in: list[Level], two: Level) -> list[_Straight | _Joined | None]:
    levels = [one, *put_in, two]
    return [_joint(low, high) for low, high in pairwise(levels)]


def _joint(low: Level, high: Level) -> _Straight | _Joined | None:
    """Return how a level's loops lead to the next one's; None when they do not."""
    counts = [_counts(level) for level in (low, high)]
    if counts[0] == counts[1]:
        order = _matched(list(low.polygons), list(high.polygons))
        return None if order is None else _Straight(order)
    upward = _handles(counts[0]) < _handles(counts[1])
    joined, parted = (low, high) if upward else (high, low)
    (outer_j, hole_j), (outer_p, hole_p) = _counts(joined), _counts(parted)
    if outer_p < outer_j or hole_p > hole_j:
        return None
    cut = cut_bridges(list(joined.polygons), list(parted.polygons), outer_p - outer_j, hole_j - hole_p)
    if cut is None:
        return None
    order = _matched([part.points for part in cut.parts], list(parted.polygons))
    return None if order is None else _Joined(cut, upward, order)


def _counts(level: Level) -> tuple[int, int]:
    holes = sum(_area(p) < 0.0 for p in level.polygons)
    return len(level.polygons) - holes, holes


def _handles(counts: tuple[int, int]) -> int:
    return counts[0] - counts[1]


def _matched(before: list[FloatArray], after: list[FloatArray]) -> tuple[int, ...] | None:
    """Return for each loop of `after` the one of `before` that it follows; None unless one to one."""
    if len(before) != len(after):
        return None
    share = np.array(
        [[overlap([a], [b]) if (_area(a) > 0) == (_area(b) > 0) else 0.0 for a in before] for b in after]
    )
    order = [-1] * len(after)
    for _ in after:
        j, i = np.unravel_index(int(np.argmax(share)), share.shape)
        if share[j, i] <= 0.0:
            return None
        order[int(j)] = int(i)
        share[j, :] = share[:, i] = -1.0
    return tuple(order)


def _step(
    builder: _Builder, low: Level, high: Level, step: _Straight | _Joined | None, tubes: list[TubeOfLoops]
) -> list[TubeOfLoops]:
    """Lead tubes from one level to the next as decided; returns them in the order of the upper loops."""
    assert step is not None
    rows = _rows(high)
    if isinstance(step, _Straight):
        following = [tubes[i] for i in step.order]
        for tube, row in zip(following, rows, strict=True):
            tube.rows.append(row)
        return following
    joined = low if step.upward else high
    number = len(builder.joints)
    builder.joints.append(tuple(np.column_stack([e, np.full(len(e), joined.z)]) for e in step.cut.edges))
    if step.upward:
        for tube, whole in zip(tubes, step.cut.wholes, strict=True):
            tube.rows[-1] = _pinned_row(tube.rows[-1], whole)
            builder.finish(tube, JointUse(number, whole.edges))
        following = []
        for part_number, row in zip(step.order, rows, strict=True):
            part = step.cut.parts[part_number]
            tube = builder.begin(_part_row(part, joined, row.hole), JointUse(number, part.edges))
            tube.rows.append(row)
            following.append(tube)
        return following
    for part_number, tube in zip(step.order, tubes, strict=True):
        part = step.cut.parts[part_number]
        tube.rows.append(_part_row(part, joined, tube.hole))
        builder.finish(tube, JointUse(number, part.edges))
    return [
        builder.begin(_pinned_row(row, whole), JointUse(number, whole.edges))
        for row, whole in zip(rows, step.cut.wholes, strict=True)
    ]


def _pinned_row(row: Row, whole: Part) -> Row:
    """Return the row with its corners at the joint's pins, on the joint's own polygon."""
    if not whole.pinned.size:
        return row
    return Row(row.z, Loop(whole.points, whole.pinned), row.name, row.section, row.hole, pinned=True)


def _part_row(part: Part, level: Level, hole: bool) -> Row:
    points, pinned = _without_short_chords(part)
    return Row(level.z, Loop(points, pinned), level.name, None, hole, pinned=True)


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
