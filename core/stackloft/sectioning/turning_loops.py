r"""Corners of many loops: a quick look at all of them at once tells which ones need the careful look.

::

    ----o----o----o        o  samples, evenly along the loop; straight lines are fitted to those behind and
         behind    \       to those ahead of every sample (the gap next to it left out), by running sums
                    o  ahead
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.smooth_curve import Turns, turns_somewhere
from stackloft.model.arrays import BoolArray, FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.traced_corners import STEP, CornerRules, with_corners

_WIDE = 2 * STEP
"""Pixels between samples: half as many as are looked at with care."""
_LESS = 10.0
"""Degrees by which a loop may turn less than a corner does and still be looked at with care. With a vertex on
about every pixel, twice as many samples move the fitted lines by a degree or two."""

ComplexArray = NDArray[np.complex128]


def with_all_corners(loops: Sequence[Loop], pixels: Sequence[float]) -> list[Loop]:
    """Return traced loops with their corners marked, as `with_corners` does for each.

    Parameters
    ----------
    loops : sequence of Loop
    pixels : sequence of float
        Pixel size of each, mm.
    """
    rules = CornerRules()
    return [
        with_corners(loop, pixel, rules) if turns else loop
        for loop, pixel, turns in zip(loops, pixels, may_turn(loops, pixels, rules), strict=True)
    ]


def may_turn(loops: Sequence[Loop], pixels: Sequence[float], rules: CornerRules) -> BoolArray:
    """Return for each traced loop whether it may have a corner.

    Parameters
    ----------
    loops : sequence of Loop
    pixels : sequence of float
        Pixel size of each, mm.
    rules : CornerRules

    Examples
    --------
    >>> t = np.linspace(0.0, 2.0 * np.pi, 600, endpoint=False)
    >>> disc = 90.0 * np.column_stack([np.cos(t), np.sin(t)])
    >>> may_turn([Loop(disc), Loop(np.maximum(disc, -45.0))], [1.0, 1.0], CornerRules()).tolist()
    [False, True]
    """
    near, far = _lines(rules)
    shortest = 16 * rules.window  # others have shorter sides
    turns = Turns(shortest, _WIDE, near, far, float(np.cos(np.radians(rules.turn - _LESS))))
    quick = turns_somewhere([loop.points for loop in loops], pixels, turns)
    if quick is not None:
        return np.array(quick, dtype=np.bool_)
    turning = np.ones(len(loops), dtype=np.bool_)
    ways = [_way(loop.points, pixel) for loop, pixel in zip(loops, pixels, strict=True)]
    steps = [np.abs(np.diff(way)) for way in ways]
    usual = [k for k, own in enumerate(steps) if own.sum() >= shortest]
    if usual:
        turning[usual] = _turns([ways[k] for k in usual], [steps[k] for k in usual], rules)
    return turning


def _lines(rules: CornerRules) -> tuple[int, int]:
    """Return the first and last sample, counted from one, that the line ahead of it is fitted to."""
    return round(rules.gap / _WIDE), round((rules.gap + rules.window) / _WIDE)


def _way(points: FloatArray, pixel: float) -> ComplexArray:
    """Return the way round a polygon, from its first vertex to that again, as complex numbers in pixels."""
    place = np.ascontiguousarray(points).view(np.complex128)[:, 0]
    way = np.zeros(len(place) + 1, dtype=np.complex128)
    np.subtract(place, place[0], out=way[:-1])
    return np.divide(way, pixel, out=way)


def _turns(ways: list[ComplexArray], steps: list[FloatArray], rules: CornerRules) -> BoolArray:
    """Return whether the lines behind and ahead of any sample of a loop differ in direction by a corner."""
    near, far = _lines(rules)
    apart = near + far  # the side behind a sample is the side ahead of the one so much earlier
    samples, counts = _resampled(ways, steps, apart, far)
    sides = _slopes(np.concatenate(samples), near, far)
    between = sides[:-apart].conj() * sides[apart:]
    sharp = between.real <= np.cos(np.radians(rules.turn - _LESS)) * np.abs(between)
    first = np.cumsum([0, *(len(own) for own in samples[:-1])])
    return np.array([sharp[a : a + count].any() for a, count in zip(first, counts, strict=True)])


def _resampled(
    ways: list[ComplexArray], steps: list[FloatArray], before: int, after: int
) -> tuple[list[ComplexArray], list[int]]:
    """Return samples evenly around each polygon, some at either end once again, and how many there are."""
    found, counts = [], []
    for way, step in zip(ways, steps, strict=True):
        along = np.concatenate([[0.0], np.cumsum(step)])
        count = round(float(along[-1]) / _WIDE)
        own = np.interp(np.arange(count) * (along[-1] / count), along, way)
        found.append(np.concatenate([own[-before:], own, own[:after]]))
        counts.append(count)
    return found, counts


def _slopes(samples: ComplexArray, near: int, far: int) -> ComplexArray:
    """Return the slope, times a constant, of the line fitted to the samples `near` … `far` after each."""
    number = np.arange(len(samples), dtype=np.float64)
    total = np.concatenate([[0.0], np.cumsum(samples)])
    moment = np.concatenate([[0.0], np.cumsum(number * samples)])
    window = slice(near, len(samples) - far + near), slice(far + 1, None)
    inside, first = total[window[1]] - total[window[0]], moment[window[1]] - moment[window[0]]
    slopes: ComplexArray = first - (number[: len(inside)] + 0.5 * (near + far)) * inside
    return slopes
