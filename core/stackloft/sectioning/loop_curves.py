"""Loops made ready for curve fitting, whatever they came from; each stack's once."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from weakref import WeakKeyDictionary

import numpy as np

from stackloft.geometry.curve_stack import CurveStack, fit_curves
from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray, IntArray, read_only
from stackloft.model.contour_stack import ContourStack, Loop
from stackloft.model.errors import InputError
from stackloft.sectioning.smoothing import smooth_loops

DENSE = 256
"""Vertices from which on every other one tells a traced loop's smooth curve, whose knots are four apart."""

_READY: WeakKeyDictionary[ContourStack, tuple[tuple[Loop, ...], ...]] = WeakKeyDictionary()
_CURVES: WeakKeyDictionary[ContourStack, CurveStack] = WeakKeyDictionary()
_SMOOTH: WeakKeyDictionary[ContourStack, dict[Loop, Loop]] = WeakKeyDictionary()


def remember_smooth(contours: ContourStack, smooth: Mapping[Loop, Loop]) -> None:
    """Remember what `smooth_loops` gave for some of a stack's loops at its resolution, to save it later."""
    _SMOOTH[contours] = dict(smooth)


def ready_loops(contours: ContourStack) -> tuple[tuple[Loop, ...], ...]:
    """Return every section's loops by `ready_loop`, smoothed when they were traced.

    They are remembered as long as the stack itself is there.

    Raises
    ------
    InputError
        A loop without area.
    """
    ready = _READY.get(contours)
    if ready is None:
        loops = iter(_smooth(contours))
        ready = tuple(
            tuple(ready_loop(loop, section.name) for loop in islice(loops, len(section.loops)))
            for section in contours.sections
        )
        _READY[contours] = ready
    return ready


def ready_curves(contours: ContourStack) -> CurveStack:
    """Return the curves through all loops of `ready_loops`, one after the other; remembered likewise.

    Raises
    ------
    InputError
        A loop without area, or no loop at all.
    """
    curves = _CURVES.get(contours)
    if curves is None:
        flat = [loop for loops in ready_loops(contours) for loop in loops]
        if not flat:
            raise InputError("there is no loop on any section")
        curves = fit_curves([loop.points for loop in flat], [loop.corners for loop in flat])
        _CURVES[contours] = curves
    return curves


def mirror_ready(contours: ContourStack, mirrored: ContourStack, flip: tuple[float, float]) -> None:
    """Remember for a stack with x and y multiplied what `ready_loops` and `ready_curves` give for the other.

    Raises
    ------
    InputError
        As these do.
    """
    _READY[mirrored] = tuple(
        tuple(_mirrored(loop, flip) for loop in loops) for loops in ready_loops(contours)
    )
    _CURVES[mirrored] = ready_curves(contours).flipped(flip)


def _mirrored(loop: Loop, flip: tuple[float, float]) -> Loop:
    """Return a counter-clockwise loop with x and y multiplied, counter-clockwise from the same vertex."""
    points = flipped_points(loop.points, flip)
    if flip[0] * flip[1] > 0.0:
        return Loop(points, loop.corners)
    back = np.concatenate([points[:1], points[:0:-1]])
    return Loop(back, np.sort(-loop.corners % len(points)))


def flipped_points(points: FloatArray, flip: tuple[float, float]) -> FloatArray:
    """Return (k, 2) points with x and y multiplied by 1 or -1.

    Examples
    --------
    >>> flipped_points(np.array([[1.0, 2.0]]), (-1.0, 1.0)).tolist()
    [[-1.0, 2.0]]
    """
    flipped = points.copy()
    for axis in (0, 1):  # a coordinate at a time: rows of two take several times as long
        if flip[axis] < 0.0:
            np.negative(points[:, axis], out=flipped[:, axis])
    return flipped


def _smooth(contours: ContourStack) -> list[Loop]:
    """Return all loops; traced ones smoothed, no denser than their curves need."""
    flat = [loop for section in contours.sections for loop in section.loops]
    if contours.exact:
        return flat
    known = _SMOOTH.get(contours, {})
    others = iter(smooth_loops([loop for loop in flat if loop not in known], contours.resolution))
    return [_thinned(known[loop] if loop in known else next(others)) for loop in flat]


def _thinned(loop: Loop) -> Loop:
    if len(loop.points) < DENSE or len(loop.corners):
        return loop
    return Loop(read_only(np.ascontiguousarray(loop.points[::2])), loop.corners, loop.hole)


def ready_loop(loop: Loop, name: str) -> Loop:
    """Return the loop counter-clockwise, without repeated points."""
    points, corners = _distinct(loop)
    area = polygon_area(points) if len(points) >= 3 else 0.0
    if abs(area) <= 1e-12 * np.abs(loop.points - loop.points[0]).max() ** 2:
        raise InputError("a loop without area", where=name, found=f"{len(points)} distinct points")
    if area < 0.0:
        points = points[::-1]
        corners = np.sort(len(points) - 1 - corners)
    return Loop(points, corners)


def _distinct(loop: Loop) -> tuple[FloatArray, IntArray]:
    """Return the loop's vertices without those that repeat the one before, and its corners."""
    points = loop.points
    step = np.abs(points - np.concatenate([points[-1:], points[:-1]]))
    keep = np.maximum(step[:, 0], step[:, 1]) > 1e-9 * np.abs(points - points[0]).max()
    if keep.all():
        return points, loop.corners
    corners = np.unique((np.cumsum(keep) - 1)[loop.corners] % max(int(keep.sum()), 1))
    return points[keep], corners
