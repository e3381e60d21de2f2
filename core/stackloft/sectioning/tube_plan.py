"""A stack of any topology made ready for lofting: levels, tubes, joints, and how every tube ends."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stackloft.geometry.curve_stack import fit_curves
from stackloft.geometry.end_model import distance_to_end
from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack, Loop
from stackloft.model.ends import End, EndKind
from stackloft.model.errors import InputError
from stackloft.model.measurement import EndReport
from stackloft.sectioning.dense_loops import curve_polygon
from stackloft.sectioning.ends import PlannedEnd, StackEnds, plan_ends
from stackloft.sectioning.loop_curves import ready_curves, ready_loops
from stackloft.sectioning.loop_links import link_loops
from stackloft.sectioning.roof import Thickness, half_thickness, roof_levels
from stackloft.sectioning.section_regions import OUTSIDE, section_regions
from stackloft.sectioning.tubes import (
    JointUse,
    Level,
    Row,
    TubeOfLoops,
    TubeSet,
    is_hole,
    make_level,
    trace_tubes,
)

SIDES = 160
"""About how many sides a section's loop has as a polygon."""
OUTER = 3
"""Levels from which an end is guessed."""
STRAY = 0.05
"""Part of a loop's length that may face away from the pole it is closed by."""
LONG = 2.2
"""Perimeter² / (4π area) of an outline that needs more points; a circle has 1, a 4.5 : 1 ellipse 2."""
FINER = 3
"""Times as many points on long loops, and on tubes with levels put in: neighbouring levels there lie so
close that the difference of two coarse curves would show as a ledge of false area."""
FACE = PlannedEnd(EndKind.FACE, 0.0, "closed over its ridge", guessed=False)


@dataclass(frozen=True, slots=True)
class TubeEnd:
    """How one end of a tube is closed."""

    planned: PlannedEnd | None
    """None at a joint."""
    joint: JointUse | None = None
    outer: bool = False
    """True at the stack's first or last section (or on the roof beyond it)."""
    opening: bool = False
    """True where a hole's plane end opens in the face around it."""


@dataclass(frozen=True, slots=True, eq=False)
class PlannedTube:
    """A tube and its ends."""

    rows: tuple[Row, ...]
    ends: tuple[TubeEnd, TubeEnd]

    @property
    def hole(self) -> bool:
        """True for a hole or cavity."""
        return self.rows[0].hole


@dataclass(frozen=True, slots=True)
class Roof:
    """A piece closed over its ridge."""

    planned: PlannedEnd
    area: float
    """mm², of its outermost section"""

    def report(self) -> EndReport:
        """Return what is told of it; a ridge's roof holds about 2/3 of area times length."""
        end = self.planned
        effect = self.area * (end.longest - end.shortest) / 3.0 if end.guessed else None
        reason = f"closed over its ridge; {end.reason}"
        return EndReport(
            end.kind.value, end.length, reason, end.guessed, effect, 0.0 if end.guessed else None
        )


@dataclass(frozen=True, slots=True, eq=False)
class TubePlan:
    """Everything a loft needs to know of a body."""

    tubes: tuple[PlannedTube, ...]
    traced: TubeSet
    roofs: tuple[tuple[Roof, ...], tuple[Roof, ...]]
    """Pieces closed over a ridge at the first and the last end."""
    areas: FloatArray
    """(m,) mm²: the sections' areas, holes by how loops are nested"""


def is_single(contours: ContourStack) -> bool:
    """Return True when every section is one loop, the outermost fit for poles: no links needed."""
    if any(len(section.loops) != 1 for section in contours.sections):
        return False
    if not contours.sections:
        return True  # nothing to link; who wants a solid of it refuses it by name
    return all(sees_all(contours.sections[k].loops[0].points) for k in (0, -1))


def more_points(contours: ContourStack) -> int:
    """Return how many times as many points the loops of single-loop sections need as compact ones do.

    N points are meant for outlines like an ellipse's; a long bent one has as much outline as several.
    """
    curves = ready_curves(contours)
    return FINER if float((curves.lengths**2 / (4.0 * np.pi * curves.areas)).max()) > LONG else 1


def plan_tubes(
    contours: ContourStack,
    said: tuple[End, End],
    height: float | None,
    filled: frozenset[int] = frozenset(),
) -> TubePlan:
    """Return a stack's tubes and how they end; `filled` as for `trace_tubes`.

    Raises
    ------
    InputError
        Loops cross, neighbouring sections cannot be linked, or ends and height contradict each other.
    UsageError
        As `plan_ends`.
    """
    levels, areas = _levels(contours)
    whole = None
    if height is not None:
        stack = StackEnds(contours.positions, areas, contours.kind, contours.thickness)
        whole = plan_ends(stack, said, height)
    sides = [_Side(contours, said, whole, at_last) for at_last in (False, True)]
    first, last = (_roofs(levels, side) for side in sides)
    traced = trace_tubes([*reversed(first.levels), *levels, *last.levels], filled)
    tubes = tuple(_planned(tube, len(levels), sides) for tube in traced.tubes)
    return TubePlan(_with_openings(tubes), traced, (tuple(first.planned), tuple(last.planned)), areas)


def _levels(contours: ContourStack) -> tuple[list[Level], FloatArray]:
    """Return the sections as levels, each loop as given and as a polygon of its curve; and their areas."""
    ready, curves = ready_loops(contours), ready_curves(contours)
    levels, k = [], 0
    areas = np.zeros(len(contours))
    for number, (section, loops) in enumerate(zip(contours.sections, ready, strict=True)):
        polygons = [
            curve_polygon(curves, k + i, float(curves.lengths[k + i]) / SIDES) for i in range(len(loops))
        ]
        level = make_level(section.z, list(loops), polygons, section.name, number)
        levels.append(level)
        areas[number] = curves.areas[k : k + len(loops)] @ [
            -1.0 if is_hole(p) else 1.0 for p in level.polygons
        ]
        k += len(loops)
    return levels, areas


@dataclass(frozen=True, slots=True, eq=False)
class _Side:
    """What is known of the stack's first or last end."""

    contours: ContourStack
    said: tuple[End, End]
    whole: tuple[PlannedEnd, PlannedEnd] | None
    at_last: bool

    def plan(self, z: FloatArray, sizes: FloatArray) -> PlannedEnd:
        """Return the end of a piece whose sizes (areas, or what closes as areas do) come outermost first."""
        if self.whole is not None:
            return self.whole[self.at_last]
        positions, values = (z[::-1], sizes[::-1]) if self.at_last else (z, sizes)
        if len(z) == 1:
            pitch = float(np.diff(self.contours.positions).min()) if len(self.contours) > 1 else 1.0
            positions = np.array([z[0], z[0] + pitch]) if not self.at_last else np.array([z[0] - pitch, z[0]])
            values = np.repeat(sizes, 2)
        stack = StackEnds(positions, values, self.contours.kind, self.contours.thickness)
        own = self.said[self.at_last]
        return plan_ends(stack, (own, own), None)[self.at_last]


@dataclass(frozen=True, slots=True, eq=False)
class _Roofs:
    """Levels beyond the outermost section, outwards, and the ends that they close."""

    levels: list[Level]
    planned: list[Roof]


def _roofs(levels: list[Level], side: _Side) -> _Roofs:
    """Return the levels that close rings and strongly bent pieces over their ridges."""
    inward = levels[::-1] if side.at_last else levels
    outward = 1.0 if side.at_last else -1.0
    outermost = inward[0]
    regions = section_regions(list(outermost.polygons), outermost.name)
    found: list[tuple[float, list[FloatArray]]] = []
    planned = []
    for k in np.flatnonzero(~regions.holes):
        piece = regions.within(int(k))
        followed = _followed(inward, int(k))
        if len(piece) == 1 and _has_pole(followed):
            continue
        thickness = Thickness(
            np.array([half_thickness(p) for _, p in followed]),
            np.array([abs(z - followed[0][0]) for z, _ in followed]),
        )
        end = side.plan(np.array([z for z, _ in followed]), thickness.half**2)
        if end.kind in {EndKind.FACE, EndKind.FLAT}:
            continue
        found += roof_levels(piece, thickness, end.length)
        planned.append(Roof(end, sum(polygon_area(p) for p in piece)))
    result = []
    for number, distance in enumerate(sorted({round(d, 12) for d, _ in found}), start=1):
        loops = [p for d, ps in found if round(d, 12) == distance for p in ps]
        name = f"roof {number} beyond {outermost.name}"
        result.append(
            make_level(outermost.z + outward * distance, [Loop(p) for p in loops], loops, name, None)
        )
    return _Roofs(result, planned)


def _followed(inward: list[Level], loop: int) -> list[tuple[float, list[FloatArray]]]:
    """Return position and polygons of a piece on the outermost levels, as far as it goes on one to one."""
    regions = [section_regions(list(level.polygons), level.name) for level in inward[:OUTER]]
    found = [(inward[0].z, regions[0].within(loop))]
    for k in range(len(regions) - 1):
        links = [linked for linked in link_loops(regions[k], regions[k + 1]) if loop in linked.before]
        if not links or not links[0].plain:
            break
        loop = links[0].after[0]
        if len(regions[k + 1].within(loop)) != len(found[0][1]):
            break  # a ring's thickness and a disc's are not of one kind
        found.append((inward[k + 1].z, regions[k + 1].within(loop)))
    return found


def _has_pole(followed: list[tuple[float, list[FloatArray]]]) -> bool:
    """Return whether the outermost loop is seen whole from where its pole would be."""
    return sees_all(followed[0][1][0])


def sees_all(points: FloatArray) -> bool:
    """Return whether a loop, (k, 2) mm, is seen whole from its centre, but for a small part."""
    side = np.roll(points, -1, axis=0) - points
    arm = points - points.mean(axis=0)
    facing = arm[:, 0] * side[:, 1] - arm[:, 1] * side[:, 0]
    length = np.hypot(side[:, 0], side[:, 1])
    astray = float(length[facing <= 0.0].sum() / length.sum())
    return min(astray, 1.0 - astray) <= STRAY  # either way round


def _planned(tube: TubeOfLoops, sections: int, sides: list[_Side]) -> PlannedTube:
    rows = list(tube.rows)
    ends = []
    for at_last in (False, True):
        told = tube.ends[at_last]
        row = rows[-1] if at_last else rows[0]
        outer = row.section == (sections - 1 if at_last else 0)
        if isinstance(told, JointUse):
            ends.append(TubeEnd(None, told))
        elif outer:
            z, areas = _outermost(rows, at_last=at_last)
            ends.append(TubeEnd(sides[at_last].plan(z, areas), outer=True))
        elif not np.isfinite(told):
            ends.append(TubeEnd(FACE, outer=True))
        else:
            rows, planned = _vanishing(rows, float(told), at_last=at_last)
            ends.append(TubeEnd(planned))
    return PlannedTube(tuple(rows), (ends[0], ends[1]))


def _outermost(rows: list[Row], *, at_last: bool) -> tuple[FloatArray, FloatArray]:
    """Return positions and areas of a tube's outermost sections, outermost first."""
    inward = rows[::-1] if at_last else rows
    real = [row for row in inward if row.section is not None]
    chosen = (real if len(real) >= 2 else inward)[:OUTER]
    return np.array([row.z for row in chosen]), np.array([abs(row.loop.signed_area) for row in chosen])


def _vanishing(rows: list[Row], gap: float, *, at_last: bool) -> tuple[list[Row], PlannedEnd]:
    """Return rows and end of a tube that ends before the next level, `gap` mm away.

    Where the areas close before that level there is a pole; otherwise a plane face half-way.
    """
    roofed = _vanishing_ridge(rows, gap, at_last=at_last)
    if roofed is not None:
        return roofed, FACE
    z, areas = _outermost(rows, at_last=at_last)
    root = distance_to_end(areas, np.abs(z - z[0])) if len(z) >= 2 else None
    if root is not None and root < gap:
        return rows, PlannedEnd(EndKind.ROUND, root, "the areas reach zero there", guessed=False)
    if len(z) == 1:
        return rows, PlannedEnd(EndKind.ROUND, 0.5 * gap, "seen on one section alone", guessed=False)
    row = rows[-1] if at_last else rows[0]
    half = replace_row(row, row.z + (0.5 * gap if at_last else -0.5 * gap))
    face = PlannedEnd(EndKind.FACE, 0.0, "half-way to the section without it", guessed=False)
    return ([*rows, half] if at_last else [half, *rows]), face


def _vanishing_ridge(rows: list[Row], gap: float, *, at_last: bool) -> list[Row] | None:
    """Return the rows with a ridge beyond a strongly bent end; None where a pole will do."""
    inward = rows[::-1] if at_last else rows
    if sees_all(inward[0].loop.points):
        return None
    chosen = [row for row in inward if row.section is not None][:OUTER] or inward[:1]
    half = np.array([half_thickness([_short_sides(row.loop)]) for row in chosen])
    depth = np.array([abs(row.z - chosen[0].z) for row in chosen])
    root = distance_to_end(half**2, depth) if len(chosen) >= 2 else None
    length = root if root is not None and root < gap else 0.5 * gap
    outermost = inward[0]
    outward = 1.0 if at_last else -1.0
    beyond = []
    for distance, loops in roof_levels([_short_sides(outermost.loop)], Thickness(half, depth), length):
        if len(loops) != 1:
            break
        beyond.append(
            Row(outermost.z + outward * distance, Loop(loops[0]), outermost.name, None, outermost.hole)
        )
    return [*rows, *beyond] if at_last else [*reversed(beyond), *rows]


def _short_sides(loop: Loop) -> FloatArray:
    curves = fit_curves([ccw(loop.points)], [np.empty(0, dtype=np.int64)])
    return curve_polygon(curves, 0, float(curves.lengths[0]) / SIDES)


def ccw(points: FloatArray) -> FloatArray:
    """Return a polygon counter-clockwise."""
    return points[::-1] if is_hole(points) else points


def replace_row(row: Row, z: float) -> Row:
    """Return a copy of a row at another position."""
    return Row(z, row.loop, row.name, None, row.hole, row.pinned)


def _with_openings(tubes: tuple[PlannedTube, ...]) -> tuple[PlannedTube, ...]:
    """Return the tubes, holes' plane outer ends marked as openings in the faces around them.

    A hole's outer end follows the piece around it: where that ends in a plane, so does the hole.
    """
    result = []
    for tube in tubes:
        ends = list(tube.ends)
        for k in (0, 1):
            if tube.hole and ends[k].outer:
                ends[k] = replace(ends[k], planned=_around(tubes, tube, k), opening=True)
        result.append(PlannedTube(tube.rows, (ends[0], ends[1])))
    return tuple(result)


def _around(tubes: tuple[PlannedTube, ...], hole: PlannedTube, k: int) -> PlannedEnd:
    """Return the end of the piece around a hole's outer end."""
    row = hole.rows[-1 if k else 0]
    best, least = None, np.inf
    for tube in tubes:
        other = tube.rows[-1 if k else 0]
        if tube.hole or not tube.ends[k].outer or other.z != row.z:
            continue
        regions = section_regions([other.loop.points, row.loop.points])
        area = abs(other.loop.signed_area)
        if regions.parents[1] != OUTSIDE and area < least:
            best, least = tube.ends[k].planned, area
    if best is None or best.kind not in {EndKind.FACE, EndKind.FLAT}:
        raise InputError(
            "a hole reaches the end of the stack, but the body around it does not end there in a face",
            where=row.name,
            fix="give --ends face or flat:LEN, or cut thinner slices",
        )
    return best
