"""Area, perimeter and centroid of whole sections, holes subtracted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.contour_stack import ContourStack
from stackloft.sectioning.loop_curves import ready_curves, ready_loops


@dataclass(frozen=True, slots=True, eq=False)
class LoopMeasures:
    """Figures of every loop of a stack, in order."""

    section: IntArray
    """(n,) section number"""
    sign: FloatArray
    """(n,) +1 outer, -1 hole"""
    areas: FloatArray
    """(n,) mm², positive"""
    perimeters: FloatArray
    """(n,) mm"""
    centroids: FloatArray
    """(n, 2) mm"""


def measure_loops(contours: ContourStack) -> LoopMeasures:
    """Return the figures of every loop, by the same curves that the loft goes through."""
    loops = ready_loops(contours)
    if not any(loops):
        empty = np.empty(0)
        return LoopMeasures(empty.astype(int), empty, empty, empty, np.empty((0, 2)))
    section = np.repeat(np.arange(len(loops)), [len(own) for own in loops])
    sign = np.array([-1.0 if loop.hole else 1.0 for one in contours.sections for loop in one.loops])
    curves = ready_curves(contours)
    return LoopMeasures(section, sign, curves.areas, curves.lengths, curves.centroids)


def section_areas(contours: ContourStack) -> FloatArray:
    """Return each section's area, mm², (m,): outer loops less holes."""
    loops = measure_loops(contours)
    total: FloatArray = np.bincount(loops.section, loops.sign * loops.areas, minlength=len(contours)).astype(
        np.float64
    )
    return total


def section_perimeters(contours: ContourStack) -> FloatArray:
    """Return each section's perimeter, mm, (m,): outer loops and holes together."""
    loops = measure_loops(contours)
    total: FloatArray = np.bincount(loops.section, loops.perimeters, minlength=len(contours)).astype(
        np.float64
    )
    return total
