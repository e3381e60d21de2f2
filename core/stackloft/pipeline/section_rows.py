"""Each section's own figures, from the curves that the loft goes through."""

from __future__ import annotations

import numpy as np

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
    count = len(contours)
    signed = measures.sign * measures.areas
    areas, perimeters = (np.bincount(measures.section, w, count) for w in (signed, measures.perimeters))
    some = np.where(areas, areas, np.nan)  # no area, no centroid
    x, y = (np.bincount(measures.section, signed * w, count) / some for w in measures.centroids.T)
    holes = [sum(loop.hole for loop in section.loops) for section in contours.sections]
    figures = zip(contours.sections, areas, perimeters, x, y, holes, strict=True)
    return tuple(
        SectionRow(k, s.z, float(area), float(edge), (float(a), float(b)), len(s.loops) - inner, inner)
        for k, (s, area, edge, a, b, inner) in enumerate(figures, start=1)
    )
