"""Stacks of a drawing: plane-faced bodies given by polygons."""

from __future__ import annotations

import numpy as np

from stackloft.model.contour_stack import ContourStack
from stackloft.sectioning.corners import turning_degrees
from stackloft.sectioning.loop_curves import ready_loops

STRAIGHT = 1e-6
"""Degrees that a vertex on a straight side may turn."""


def is_drawn(contours: ContourStack) -> bool:
    """Return whether all loops are exact polygons: straight sides between corners.

    Nothing that was traced or digitised is. Whoever draws a plane-faced body puts a section at every height
    at which its shape changes.

    Examples
    --------
    >>> from stackloft.model.contour_stack import Loop, Section
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0], [0.0, 1.0]])
    >>> is_drawn(ContourStack((Section(0.0, (Loop(square, np.array([0, 1, 2, 4])),), "a"),)))
    True
    """
    if not contours.exact:
        return False
    for loops in ready_loops(contours):
        for loop in loops:
            between = np.ones(len(loop.points), dtype=bool)
            between[loop.corners] = False
            if (np.abs(turning_degrees(loop.points))[between] > STRAIGHT).any():
                return False
    return True
