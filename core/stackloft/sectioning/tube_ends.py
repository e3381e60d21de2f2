"""How every tube of a stack ends."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stackloft.geometry.curve_stack import fit_curves
from stackloft.geometry.end_model import distance_to_end
from stackloft.geometry.second_moments import central_moments
from stackloft.geometry.shoelace import polygon_perimeter
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.model.ends import EndKind
from stackloft.model.errors import InputError
from stackloft.sectioning.dense_loops import curve_polygon
from stackloft.sectioning.ends import PlannedEnd
from stackloft.sectioning.levels import is_hole
from stackloft.sectioning.line_roof import moved
from stackloft.sectioning.outermost_rows import arch_lengths, half_widths, outermost, sizes
from stackloft.sectioning.roof import TURNS, Thickness, half_thickness, roof_levels
from stackloft.sectioning.section_regions import OUTSIDE, section_regions
from stackloft.sectioning.stack_roofs import OUTER, Side, sees_all
from stackloft.sectioning.tube_rows import JointUse, Row, TubeOfLoops

SIDES = 160
"""About how many sides a section's loop has as a polygon."""
LATE = 2.0
"""Areas that reach zero within this many gaps belong to a round end, later ones to a plane one."""
SLENDER = 1.25
"""Perimeter² / (4π area) above which an outline that is all there is closes over its length: that of an
ellipse of 2.2 : 1. A pole over one of 4 : 1, flat as it is, has half as much area again."""
FACE = PlannedEnd(EndKind.FACE, 0.0, "closed over its ridge", guessed=False)
ON_SECTION = PlannedEnd(EndKind.FACE, 0.0, "given: its outermost section is its face", guessed=False)


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


def planned_tube(
    tube: TubeOfLoops, sections: int, sides: list[Side], *, inner_faces: bool = False
) -> PlannedTube:
    """Return a tube with its ends decided; rows are added where it ends between two sections.

    With `inner_faces` what ends there ends in a plane face on its own outermost section.

    Raises
    ------
    InputError
        With `inner_faces`: a loop that one section alone shows.
    """
    rows = list(tube.rows)
    ends = []
    for at_last in (False, True):
        told = tube.ends[at_last]
        row = rows[-1] if at_last else rows[0]
        outer = row.section == (sections - 1 if at_last else 0)
        if isinstance(told, JointUse):
            ends.append(TubeEnd(None, told))
        elif outer:
            chosen = outermost(rows, at_last=at_last)
            z, areas = sizes(chosen)
            arch = arch_lengths(chosen)
            size = areas if arch is None else arch
            ends.append(TubeEnd(sides[at_last].plan(z, size, half_widths(chosen)), outer=True))
        elif not np.isfinite(told):
            ends.append(TubeEnd(FACE, outer=True))
        elif inner_faces:
            ends.append(TubeEnd(ON_SECTION))
        else:
            rows, planned = _vanishing(rows, float(told), at_last=at_last)
            ends.append(TubeEnd(planned))
    if len(rows) == 1 and all(end.planned is ON_SECTION for end in ends):
        raise InputError(
            "a loop that one section alone shows cannot end in faces on its first and last section",
            where=rows[0].name,
            fix="give the section at its other end too, or leave inner_ends at auto",
        )
    return PlannedTube(tuple(rows), (ends[0], ends[1]))


def _vanishing(rows: list[Row], gap: float, *, at_last: bool) -> tuple[list[Row], PlannedEnd]:
    """Return rows and end of a tube that ends before the next level, `gap` mm away.

    Where the areas close before that level, or not long after it, there is a pole; otherwise a plane face
    half-way.
    """
    roofed = _vanishing_ridge(rows, gap, at_last=at_last) or _vanishing_line(rows, gap, at_last=at_last)
    if roofed is not None:
        return roofed, FACE
    z, areas = sizes(outermost(rows, at_last=at_last))
    root = distance_to_end(areas, np.abs(z - z[0])) if len(z) >= 2 else None
    if root is not None and root < LATE * gap:
        # A body that closed later would show on the next section: it is blunter than the areas say.
        reason = (
            "the areas reach zero there" if root < gap else "the areas reach zero later: held to one pitch"
        )
        return rows, PlannedEnd(EndKind.ROUND, min(root, gap), reason, guessed=False)
    if len(z) == 1:
        return rows, PlannedEnd(EndKind.ROUND, 0.5 * gap, "seen on one section alone", guessed=False)
    if sum(row.section is not None for row in rows) == 1:
        # Nothing says that it is blunt; a dome holds as much as a plane face half-way would.
        return rows, PlannedEnd(EndKind.ROUND, 0.75 * gap, "seen on one section alone", guessed=False)
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


def _vanishing_line(rows: list[Row], gap: float, *, at_last: bool) -> list[Row] | None:
    """Return one slender row with levels that close over its length half-way to the next level.

    None of other rows. A pole over a lying limb's middle would have its skin overshoot; of a limb seen once
    the square of the width is taken to go straight to zero.
    """
    row = rows[0]
    points = row.loop.points
    if len(rows) > 1 or polygon_perimeter(points) ** 2 < 4.0 * np.pi * SLENDER * abs(row.loop.signed_area):
        return None
    moments, centre = central_moments(points)
    across = np.linalg.eigh(moments)[1][:, 0]
    outward = 1.0 if at_last else -1.0
    beyond = []
    for part in np.cos(TURNS).tolist():
        matrix = np.eye(2) - (1.0 - part) * np.outer(across, across)
        loop = moved(row.loop, matrix, centre - matrix @ centre)
        z = row.z + outward * 0.5 * gap * (1.0 - part**2)
        beyond.append(Row(z, loop, row.name, None, row.hole))
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


def with_openings(tubes: tuple[PlannedTube, ...]) -> tuple[PlannedTube, ...]:
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
