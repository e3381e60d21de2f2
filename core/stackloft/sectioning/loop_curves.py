"""A loop made ready for curve fitting, whatever it came from."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.contour_stack import ContourStack, Loop
from stackloft.model.errors import InputError
from stackloft.sectioning.smoothing import smooth_loop


def ready_loop(loop: Loop, contours: ContourStack, name: str) -> Loop:
    """Return the loop counter-clockwise, without repeated points, smoothed when it was traced."""
    if not contours.exact:
        loop = smooth_loop(loop, contours.resolution)
    points, corners = _distinct(loop)
    area = polygon_area(points) if len(points) >= 3 else 0.0
    if abs(area) <= 1e-12 * np.ptp(loop.points, axis=0).max() ** 2:
        raise InputError("a loop without area", where=name, found=f"{len(points)} distinct points")
    if area < 0.0:
        points = points[::-1]
        corners = np.sort(len(points) - 1 - corners)
    return Loop(points, corners)


def _distinct(loop: Loop) -> tuple[FloatArray, IntArray]:
    """Return the loop's vertices without those that repeat the one before, and its corners."""
    points = loop.points
    step = np.abs(points - np.concatenate([points[-1:], points[:-1]])).max(axis=1)
    keep = step > 1e-9 * np.abs(points - points[0]).max()
    if keep.all():
        return points, loop.corners
    corners = np.unique((np.cumsum(keep) - 1)[loop.corners] % max(int(keep.sum()), 1))
    return points[keep], corners
