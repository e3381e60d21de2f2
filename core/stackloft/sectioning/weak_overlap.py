"""Sections of one loop each that hardly overlap: cut too coarsely for what lies between them to be known."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.second_moments import half_axes
from stackloft.model.contour_stack import ContourStack
from stackloft.model.notices import Notice
from stackloft.sectioning.equal_points import EqualSections
from stackloft.sectioning.link_notices import carried_far, turned_notice, weak_notice
from stackloft.sectioning.loop_links import BELONG
from stackloft.sectioning.section_regions import overlap

MOVED = 0.5
"""Loops whose centres lie closer, in half widths of the slimmer one, overlap in any case."""


def weak_overlaps(sections: EqualSections, contours: ContourStack) -> list[Notice]:
    """Return a notice for every section that overlaps the one before by less than 30 % of the smaller.

    And for every long one that lies on little more than half of itself.
    """
    plane, centres = sections.points[..., :2], sections.curves.centroids
    moved = np.linalg.norm(np.diff(centres, axis=0), axis=1)
    widths = half_axes(plane)[:, 1]
    perhaps = np.flatnonzero(moved > MOVED * np.minimum(widths[1:], widths[:-1]))
    names = [section.name for section in contours.sections]
    notices = []
    for k in perhaps:
        one, two = plane[k], plane[k + 1]
        if overlap([one], [two]) < BELONG:
            notices.append(weak_notice(names[k], names[k + 1]))
        elif carried_far(one, two):
            notices.append(turned_notice(names[k], names[k + 1]))
    return notices
