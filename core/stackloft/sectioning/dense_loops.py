"""Sections' curves as polygons of short sides."""

from __future__ import annotations

import math

import numpy as np

from stackloft.geometry.curve_stack import CurveStack
from stackloft.model.arrays import FloatArray, IntArray
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


def even_polygon(curves: CurveStack, k: int, corners: IntArray, fewest: int) -> FloatArray:
    """Return curve k as a polygon of even sides, (n, 2) mm: the same wherever its own vertices lie.

    Parameters
    ----------
    curves : CurveStack
    k : int
    corners : (c,) array
        Vertices of the curve that the polygon goes through; its sides are even between them. Without any it
        begins at the canonical start and n is even, so that mirrored curves get mirrored polygons.
    fewest : int
        Sides at least; there are no fewer than the curve has vertices.

    Examples
    --------
    >>> from stackloft.geometry.curve_stack import fit_curves
    >>> t = 0.1 + 2 * np.pi * np.arange(50) / 50
    >>> curves = fit_curves([np.column_stack([np.cos(t), np.sin(t)])], [np.array([], dtype=int)])
    >>> polygon = even_polygon(curves, 0, np.array([], dtype=int), 80)
    >>> len(polygon), (polygon[::20].round(6) + 0.0).tolist()
    (80, [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    """
    count = max(fewest, int(curves.first[k + 1] - curves.first[k]))
    if not len(corners):
        count += count % 2
        return curves.at(np.full(count, k), np.arange(count) / count)[0]
    places = np.sort(curves.knots[curves.first[k] + corners] - k)
    gaps = np.diff(np.append(places, places[0] + 1.0))
    pieces = [
        place + gap * (np.arange(parts) / parts)
        for place, gap in zip(places, gaps, strict=True)
        for parts in (max(1, math.ceil(count * gap - 1e-6)),)
    ]
    fractions = np.concatenate(pieces)
    return curves.at(np.full(len(fractions), k), fractions - curves.starts[k])[0]
