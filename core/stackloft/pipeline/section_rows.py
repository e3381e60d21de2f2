"""Each section's own figures, from the curves that the loft goes through."""

from __future__ import annotations

from stackloft.model.contour_stack import ContourStack
from stackloft.model.measurement import SectionRow
from stackloft.sectioning.section_measures import measure_loops


def section_rows(contours: ContourStack) -> tuple[SectionRow, ...]:
    """Return area, perimeter, centroid and number of loops of every section.

    Holes count against area and centroid, and with the perimeter.

    Examples
    --------
    >>> import numpy as np
    >>> from stackloft.model.contour_stack import Loop, Section
    >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    >>> row, = section_rows(ContourStack((Section(5.0, (Loop(square, np.arange(4)),), "a"),)))
    >>> row.area, row.perimeter, row.centroid, row.loops, row.holes
    (4.0, 8.0, (1.0, 1.0), 1, 0)
    """
    measures = measure_loops(contours)
    rows = []
    for index, section in enumerate(contours.sections):
        own = measures.section == index
        signed = measures.sign[own] * measures.areas[own]
        area = float(signed.sum())
        x, y = (signed @ measures.centroids[own] / area) if area else (float("nan"), float("nan"))
        holes = sum(loop.hole for loop in section.loops)
        perimeter = float(measures.perimeters[own].sum())
        outer = len(section.loops) - holes
        rows.append(SectionRow(index + 1, section.z, area, perimeter, (float(x), float(y)), outer, holes))
    return tuple(rows)
