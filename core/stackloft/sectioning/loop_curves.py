"""Loops made ready for curve fitting, whatever they came from; each stack's once."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice, pairwise
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
        names = [section.name for section in contours.sections for _ in section.loops]
        smooth = _smooth(contours)
        loops = iter(
            Loop(loop.points, loop.corners) if sound else ready_loop(loop, name)
            for loop, sound, name in zip(smooth, _sound(smooth), names, strict=True)
        )
        ready = tuple(tuple(islice(loops, len(section.loops))) for section in contours.sections)
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
    given = ready_loops(contours)
    loops = iter(_mirrored([loop for own in given for loop in own], flip))
    _READY[mirrored] = tuple(tuple(islice(loops, len(own))) for own in given)
    _CURVES[mirrored] = ready_curves(contours).flipped(flip)


def _mirrored(loops: list[Loop], flip: tuple[float, float]) -> list[Loop]:
    """Return counter-clockwise loops with x and y multiplied, counter-clockwise from the same vertices."""
    points = flipped_points([loop.points for loop in loops], flip)
    if flip[0] * flip[1] > 0.0:
        return [Loop(own, loop.corners) for own, loop in zip(points, loops, strict=True)]
    return [
        Loop(np.concatenate([own[:1], own[:0:-1]]), np.sort(-loop.corners % len(own)))
        for own, loop in zip(points, loops, strict=True)
    ]


def flipped_points(loops: list[FloatArray], flip: tuple[float, float]) -> list[FloatArray]:
    """Return (k_i, 2) points with x and y multiplied by 1 or -1, all loops' at once.

    Examples
    --------
    >>> [points.tolist() for points in flipped_points([np.array([[1.0, 2.0]])], (-1.0, 1.0))]
    [[[-1.0, 2.0]]]
    """
    if not loops:
        return []
    flipped = np.concatenate(loops)
    for axis in (0, 1):  # a coordinate at a time: rows of two take several times as long
        if flip[axis] < 0.0:
            np.negative(flipped[:, axis], out=flipped[:, axis])
    stops = np.cumsum([len(points) for points in loops]).tolist()
    return [read_only(flipped[start:stop]) for start, stop in pairwise([0, *stops])]


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


def _sound(loops: list[Loop]) -> list[bool]:
    """Return which loops are as `ready_loop` would leave them: told for all at once."""
    if not loops:
        return []
    counts = np.array([len(loop.points) for loop in loops])
    first = np.cumsum(counts) - counts
    points = np.concatenate([loop.points for loop in loops])
    arms = [each - np.repeat(each[first], counts) for each in points.T]
    before = np.arange(-1, len(points) - 1)
    before[first] += counts
    steps = [np.abs(arm - arm.take(before)) for arm in arms]
    shortest = np.minimum.reduceat(np.maximum(*steps), first)
    size = np.maximum(*(np.maximum.reduceat(np.abs(arm), first) for arm in arms))
    doubled = np.add.reduceat(arms[0].take(before) * arms[1] - arms[1].take(before) * arms[0], first)
    sound: list[bool] = ((counts > 2) & (shortest > 1e-9 * size) & (0.5 * doubled > 1e-12 * size**2)).tolist()
    return sound


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
