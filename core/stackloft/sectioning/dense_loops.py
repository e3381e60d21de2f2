"""Sections' curves as polygons of short sides."""

from __future__ import annotations

import math

import numpy as np

from stackloft.geometry.curve_stack import CurveStack
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack
from stackloft.sectioning.loop_curves import ready_curves, ready_loops


def dense_loops(contours: ContourStack, step: float) -> list[list[FloatArray]]:
    """Return every section's loops, the same curves that the loft goes through, in sides up to `step` mm.

    Returns
    -------
    list, one item per section, of (k, 2) arrays
        The loop's own vertices are among the points.

    Examples
    --------
    >>> from stackloft.model.contour_stack import Loop, Section
    >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    >>> stack = ContourStack((Section(0.0, (Loop(square, np.arange(4)),), "a"),))
    >>> (polygon,), = dense_loops(stack, 0.5)
    >>> polygon[:5].tolist()
    [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.5, 0.0], [2.0, 0.0]]
    """
    ready = ready_loops(contours)
    if not any(ready):
        return [[] for _ in ready]
    curves = ready_curves(contours)
    polygons = iter([curve_polygon(curves, k, step) for k in range(len(curves))])
    return [[next(polygons) for _ in loops] for loops in ready]


def curve_polygon(curves: CurveStack, k: int, step: float) -> FloatArray:
    """Return curve k as a polygon of sides up to `step` mm, its own vertices among the points, (n, 2) mm."""
    knots = curves.knots[curves.first[k] : curves.first[k + 1] + 1]
    parts = max(1, math.ceil(curves.lengths[k] * float(np.diff(knots).max()) / step))
    fractions = (knots[:-1, None] + np.diff(knots)[:, None] * (np.arange(parts) / parts)).ravel()
    points, _ = curves.at(np.full(len(fractions), k), fractions - k - curves.starts[k])
    return points
