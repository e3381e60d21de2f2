"""Which pieces close over a ridge at the first and last section, and the levels that do it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack, Loop
from stackloft.model.ends import End, EndKind
from stackloft.model.measurement import EndReport
from stackloft.sectioning.ends import PlannedEnd, StackEnds, plan_ends
from stackloft.sectioning.levels import Level, make_level
from stackloft.sectioning.line_roof import LineEnd, line_end, moved
from stackloft.sectioning.loop_links import link_loops
from stackloft.sectioning.roof import Thickness, half_thickness, roof_levels
from stackloft.sectioning.section_regions import section_regions

OUTER = 3
"""Levels from which an end is guessed."""
STRAY = 0.05
"""Part of a loop's length that may face away from the pole it is closed by."""


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
class Side:
    """What is known of the stack's first or last end."""

    contours: ContourStack
    said: tuple[End, End]
    whole: tuple[PlannedEnd, PlannedEnd] | None
    at_last: bool

    def plan(self, z: FloatArray, sizes: FloatArray, half_widths: FloatArray | None = None) -> PlannedEnd:
        """Return the end of a piece whose sizes (areas, or what closes as areas do) come outermost first.

        `half_widths` are those of sections that may be a limb's.
        """
        if self.whole is not None:
            return self.whole[self.at_last]
        positions, values = (z[::-1], sizes[::-1]) if self.at_last else (z, sizes)
        if half_widths is not None and self.at_last:
            half_widths = half_widths[::-1]
        if len(z) == 1:
            pitch = float(np.diff(self.contours.positions).min()) if len(self.contours) > 1 else 1.0
            positions = np.array([z[0], z[0] + pitch]) if not self.at_last else np.array([z[0] - pitch, z[0]])
            values, half_widths = np.repeat(sizes, 2), None
        kind, thickness = self.contours.kind, self.contours.thickness
        stack = StackEnds(positions, values, kind, thickness, half_widths=half_widths)
        own = self.said[self.at_last]
        return plan_ends(stack, (own, own), None)[self.at_last]


@dataclass(frozen=True, slots=True, eq=False)
class Roofs:
    """Levels beyond the outermost section, outwards, and the ends that they close."""

    levels: list[Level]
    planned: list[Roof]


def roofs_of(levels: list[Level], side: Side) -> Roofs:
    """Return the levels that close rings, strongly bent pieces and straight rims over their ridges."""
    inward = levels[::-1] if side.at_last else levels
    outward = 1.0 if side.at_last else -1.0
    outermost = inward[0]
    regions = section_regions(list(outermost.polygons), outermost.name)
    found: list[_Put] = []
    planned = []
    for k in np.flatnonzero(~regions.holes):
        piece = regions.within(int(k))
        followed = _followed(inward, int(k))
        area = sum(polygon_area(p) for p in piece)
        if len(piece) == 1 and _has_pole(followed):
            line = line_end([(z, polygons[0]) for z, polygons in followed])
            if line is not None:
                end = side.plan(np.array([z for z, _ in followed]), line.across)
                if end.kind is EndKind.ROUND:
                    found += _line_levels(line, end.length, outermost, int(k))
                    planned.append(Roof(end, area))
            continue
        thickness = Thickness(
            np.array([half_thickness(p) for _, p in followed]),
            np.array([abs(z - followed[0][0]) for z, _ in followed]),
        )
        end = side.plan(np.array([z for z, _ in followed]), thickness.half**2)
        if end.kind in {EndKind.FACE, EndKind.FLAT}:
            continue
        found += [_Put(d, [Loop(p) for p in ps], ps) for d, ps in roof_levels(piece, thickness, end.length)]
        planned.append(Roof(end, area))
    result = []
    for number, distance in enumerate(sorted({round(put.distance, 12) for put in found}), start=1):
        here = [put for put in found if round(put.distance, 12) == distance]
        loops, polygons = [loop for p in here for loop in p.loops], [q for p in here for q in p.polygons]
        name = f"roof {number} beyond {outermost.name}"
        result.append(make_level(outermost.z + outward * distance, loops, polygons, name, None))
    return Roofs(result, planned)


class _Put(NamedTuple):
    """Loops of one piece put in beyond the outermost section."""

    distance: float
    """mm"""
    loops: list[Loop]
    polygons: list[FloatArray]


def _line_levels(line: LineEnd, length: float, outermost: Level, k: int) -> list[_Put]:
    loop, polygon = outermost.loops[k], Loop(outermost.polygons[k])
    return [
        _Put(distance, [moved(loop, matrix, shift)], [moved(polygon, matrix, shift).points])
        for distance, matrix, shift in line.levels(length)
    ]


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
