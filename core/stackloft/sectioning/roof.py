r"""How a body ends that has no pole: a ring, or a strongly bent piece, closes over its ridge.

::

        ___     ___          the levels put in are inward offsets of the last section;
       /   \   /   \         their depth follows half the thickness to zero as the
      |     | |     |        last three sections say, as A does for a pole
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.polygon_distance import signed_distance
from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.sectioning.sections_between import plane_grid, zero_lines

TURNS = np.radians([18.0, 36.0, 54.0, 68.0, 79.0])
"""Where levels are put in: half the thickness is its cosine, as on a round ridge."""
FEWEST = 2
RING = 2
"""Loops of a ring."""


@dataclass(frozen=True, slots=True, eq=False)
class Thickness:
    """Half the thickness of a piece over its outermost levels."""

    half: FloatArray
    """(k,) mm: radius of the largest inscribed circle, outermost first"""
    depth: FloatArray
    """(k,) mm inwards from the outermost"""


def half_thickness(polygons: list[FloatArray]) -> float:
    """Return half the thickness of a piece, mm: a ring's on average, else its largest circle's radius."""
    if len(polygons) == RING:
        areas = [abs(polygon_area(p)) for p in polygons]
        around = [np.linalg.norm(np.roll(p, -1, axis=0) - p, axis=1).sum() for p in polygons]
        return float((max(areas) - min(areas)) / sum(around))
    x, y = plane_grid(polygons)
    return float(signed_distance(x, y, polygons).max())


def roof_levels(
    polygons: list[FloatArray], thickness: Thickness, length: float
) -> list[tuple[float, list[FloatArray]]]:
    """Return (distance beyond the outermost section, loops) of the levels of a roof, outwards.

    Parameters
    ----------
    polygons : list of (k, 2) arrays
        The outermost section's piece, short sides, mm.
    thickness : Thickness
    length : float
        mm from that section to the ridge.
    """
    x, y = plane_grid(polygons)
    field = _across_ring(x, y, polygons) if len(polygons) == RING else signed_distance(x, y, polygons)
    most = float(field.max())
    levels = []
    for turn in TURNS:
        part = float(np.cos(turn))
        distance = closing_depth(part, thickness, length)
        loops = zero_lines(field - most * (1.0 - part), x, y)
        if loops:
            levels.append((distance, loops))
    return levels


def closing_depth(part: float, thickness: Thickness, length: float) -> float:
    """Return how far beyond the outermost section the thickness is `part` of what it is there, mm."""
    return length * _fraction(part**2, _slope_at_start(thickness, length))


def _across_ring(x: FloatArray, y: FloatArray, polygons: list[FloatArray]) -> FloatArray:
    """Return 1 on a ring's middle line, 0 on both its edges, however thick it is."""
    outer, inner = sorted(polygons, key=lambda p: -abs(polygon_area(p)))
    from_outer, from_inner = signed_distance(x, y, [outer]), -signed_distance(x, y, [inner])
    return np.asarray(
        1.0 - np.abs(from_outer - from_inner) / np.maximum(np.abs(from_outer) + np.abs(from_inner), 1e-300)
    )


def _slope_at_start(thickness: Thickness, length: float) -> float:
    """Return b of h²(t)/h²(0) = (1 - t)(1 + b·t), t in units of the length, from the outermost sections."""
    squared = (thickness.half / thickness.half[0]) ** 2
    t = -thickness.depth / length
    if len(t) < FEWEST:
        return 0.0  # h² straight: the ridge of a body that is large beside its last pitch
    # squared = (1 - t)(1 + b t) at the next sections
    b = (squared[1:] / (1.0 - t[1:]) - 1.0) / t[1:]
    if len(b) == 1:
        return float(np.clip(b[0], -0.9, 1.0))
    # towards t = 0, where it counts
    start = b[0] + (b[1] - b[0]) * (0.0 - t[1]) / (t[2] - t[1])
    return float(np.clip(start, -0.9, 1.0))


def _fraction(value: float, b: float) -> float:
    """Return t in [0, 1] with (1 - t)(1 + b·t) = value."""
    if abs(b) < 1e-9:
        return 1.0 - value
    # b t² + (1 - b) t + (value - 1) = 0
    half = 0.5 * (1.0 - b)
    root = np.sqrt(max(half * half + b * (1.0 - value), 0.0))
    return float(np.clip((root - half) / b, 0.0, 1.0))
