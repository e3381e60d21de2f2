"""A stack of any topology made ready for lofting: levels, tubes, joints, and how every tube ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack
from stackloft.model.ends import End
from stackloft.sectioning.dense_loops import even_polygon
from stackloft.sectioning.ends import StackEnds, plan_ends
from stackloft.sectioning.levels import Level, is_hole, make_level
from stackloft.sectioning.line_roof import line_end
from stackloft.sectioning.loop_curves import ready_curves, ready_loops
from stackloft.sectioning.mends import STRAIGHT, Mends
from stackloft.sectioning.stack_roofs import OUTER, Roof, Side, roofs_of, sees_all
from stackloft.sectioning.tube_ends import (
    SIDES,
    PlannedTube,
    planned_tube,
    with_openings,
)
from stackloft.sectioning.tubes import TubeSet, trace_tubes

SPECK = 1e-6
"""Loops below this fraction of the section's largest are no part of any body."""
LONG = 2.2
"""Perimeter² / (4π area) of an outline that needs more points; a circle has 1, a 4.5 : 1 ellipse 2."""
FINER = 3
"""Times as many points on long loops, and on tubes with levels put in: neighbouring levels there lie so
close that the difference of two coarse curves would show as a ledge of false area."""


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
    if contours.hints.links or any(len(section.loops) != 1 for section in contours.sections):
        return False
    if not contours.sections:
        return True  # nothing to link; who wants a solid of it refuses it by name
    outwards = [(section.z, section.loops[0].points) for section in contours.sections]
    return all(
        sees_all(side[0][1]) and line_end(side) is None for side in (outwards[:OUTER], outwards[::-1][:OUTER])
    )


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
    mended: Mends = STRAIGHT,
    *,
    inner_faces: bool = False,
) -> TubePlan:
    """Return a stack's tubes and how they end.

    `mended` is as for `trace_tubes`, `inner_faces` as for `planned_tube`.

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
        stack = StackEnds(contours.positions, areas, contours.kind, contours.thickness, contours.seen_beyond)
        whole = plan_ends(stack, said, height)
    sides = [Side(contours, said, whole, at_last) for at_last in (False, True)]
    first, last = (roofs_of(levels, side) for side in sides)
    traced = trace_tubes([*reversed(first.levels), *levels, *last.levels], mended, contours.hints.links)
    tubes = tuple(planned_tube(tube, len(levels), sides, inner_faces=inner_faces) for tube in traced.tubes)
    return TubePlan(with_openings(tubes), traced, (tuple(first.planned), tuple(last.planned)), areas)


def _levels(contours: ContourStack) -> tuple[list[Level], FloatArray]:
    """Return the sections as levels, each loop as given and as a polygon of its curve; and their areas."""
    ready, curves = ready_loops(contours), ready_curves(contours)
    levels, k = [], 0
    areas = np.zeros(len(contours))
    for number, (section, loops) in enumerate(zip(contours.sections, ready, strict=True)):
        polygons = [even_polygon(curves, k + i, loop.corners, SIDES) for i, loop in enumerate(loops)]
        own = curves.areas[k : k + len(loops)]
        # From left to right: the order in which loops were given decides no tie.
        kept = np.flatnonzero(own >= SPECK * own.max(initial=0.0))
        kept = kept[np.lexsort(np.round(curves.centroids[k + kept], 6).T)]
        level = make_level(
            section.z, [loops[i] for i in kept], [polygons[i] for i in kept], section.name, number
        )
        levels.append(level)
        areas[number] = own[kept] @ [-1.0 if is_hole(p) else 1.0 for p in level.polygons]
        k += len(loops)
    return levels, areas
