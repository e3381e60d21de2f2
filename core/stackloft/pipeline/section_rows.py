"""Each section's own figures, from its loops as polygons."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.shoelace import polygon_area, polygon_centroid, polygon_perimeter
from stackloft.model.contour_stack import ContourStack, Section
from stackloft.model.measurement import SectionRow


def section_rows(contours: ContourStack) -> tuple[SectionRow, ...]:
    """Return area, perimeter, centroid and number of loops of every section.

    Holes count against area and centroid, and with the perimeter. The loops are taken as the polygons
    they are given as: on contours traced at pixel size h the area errs by O(h²).

    Examples
    --------
    >>> from stackloft.model.contour_stack import Loop
    >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    >>> row, = section_rows(ContourStack((Section(5.0, (Loop(square),), "a"),)))
    >>> row.area, row.perimeter, row.centroid, row.loops, row.holes
    (4.0, 8.0, (1.0, 1.0), 1, 0)
    """
    return tuple(_row(index, section) for index, section in enumerate(contours.sections, start=1))


def _row(index: int, section: Section) -> SectionRow:
    area, perimeter, moment = 0.0, 0.0, np.zeros(2)
    for loop in section.loops:
        own = abs(polygon_area(loop.points)) * (-1.0 if loop.hole else 1.0)
        area += own
        perimeter += polygon_perimeter(loop.points)
        moment += own * polygon_centroid(loop.points)
    x, y = (moment / area) if area else (float("nan"), float("nan"))
    holes = sum(loop.hole for loop in section.loops)
    return SectionRow(
        index, section.z, area, perimeter, (float(x), float(y)), len(section.loops) - holes, holes
    )
