"""A loop made ready for curve fitting, whatever it came from."""

from __future__ import annotations

import numpy as np

from stackloft.model.contour_stack import ContourStack, Loop
from stackloft.model.errors import InputError
from stackloft.sectioning.smoothing import smooth_loop


def ready_loop(loop: Loop, contours: ContourStack, name: str) -> Loop:
    """Return the loop counter-clockwise, without repeated points, smoothed when it was traced."""
    if not contours.exact:
        loop = smooth_loop(loop, contours.resolution)
    points = np.asarray(loop.points)
    size = np.ptp(points, axis=0).max()
    step = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)
    keep = step > 1e-9 * size
    corners = np.unique((np.cumsum(keep) - 1)[loop.corners] % max(int(keep.sum()), 1))
    points = points[keep]
    if len(points) < 3 or abs(Loop(points).signed_area) < 1e-12 * size**2:
        raise InputError("a loop without area", where=name, found=f"{len(points)} distinct points")
    if Loop(points).signed_area < 0.0:
        points = points[::-1]
        corners = np.sort(len(points) - 1 - corners)
    return Loop(points, corners)
