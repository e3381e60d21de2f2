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

from stackloft.model.arrays import BoolArray, FloatArray, IntArray
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
    turning = np.ones(len(loops), dtype=np.bool_)
    ways = [_way(loop.points) / pixel for loop, pixel in zip(loops, pixels, strict=True)]
    around = [float(_lengths(np.diff(way)).sum()) + abs(way[-1]) for way in ways]
    usual = [k for k, length in enumerate(around) if length / 16 >= rules.window]  # others have shorter sides
    if usual:
        turning[usual] = _turns([ways[k] for k in usual], rules)
    return turning


def _way(points: FloatArray) -> ComplexArray:
    """Return the points as complex numbers from the first of them."""
    return np.ascontiguousarray(points - points[0]).view(np.complex128)[:, 0]


def _lengths(steps: ComplexArray) -> FloatArray:
    """Return the absolute values, in a third of the time of those that never overflow."""
    return np.asarray(np.sqrt(steps.real**2 + steps.imag**2))


def _turns(ways: list[ComplexArray], rules: CornerRules) -> BoolArray:
    """Return whether the lines behind and ahead of any sample of a loop differ in direction by a corner."""
    near, far = round(rules.gap / _WIDE), round((rules.gap + rules.window) / _WIDE)
    samples, counts = _resampled(ways, far)
    starts = np.cumsum(counts + far) - (counts + far)
    number = np.arange(len(samples)) - np.repeat(starts, counts + far)
    ahead = _slopes(samples, number.astype(np.float64), near, far)
    loop = np.repeat(np.arange(len(counts)), counts)
    here = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    behind = ahead[starts[loop] + (here - near - far) % counts[loop]]
    between = behind.conj() * ahead[starts[loop] + here]
    sharp = between.real <= np.cos(np.radians(rules.turn - _LESS)) * _lengths(between)
    return np.bincount(loop[sharp], minlength=len(counts)) > 0


def _resampled(ways: list[ComplexArray], more: int) -> tuple[ComplexArray, IntArray]:
    """Return samples evenly around each closed polygon, `more` of them once again, and how many there are."""
    closed = np.concatenate([part for way in ways for part in (way, way[:1])])
    sizes = np.array([len(way) + 1 for way in ways])
    first = np.cumsum(sizes) - sizes
    steps = _lengths(np.diff(closed))
    steps[first[1:] - 1] = 1.0  # from one polygon to the next
    along = np.concatenate([[0.0], np.cumsum(steps)])
    lengths = along[first + sizes - 1] - along[first]
    counts = np.rint(lengths / _WIDE).astype(np.int64)
    wanted = [
        start + length / count * (np.arange(count + more) % count)
        for start, length, count in zip(along[first], lengths, counts, strict=True)
    ]
    return np.interp(np.concatenate(wanted), along, closed), counts


def _slopes(samples: ComplexArray, number: FloatArray, near: int, far: int) -> ComplexArray:
    """Return the slope, times a constant, of the line fitted to the samples `near` … `far` after each."""
    total = np.concatenate([[0.0], np.cumsum(samples)])
    moment = np.concatenate([[0.0], np.cumsum(number * samples)])
    window = slice(near, len(samples) - far + near), slice(far + 1, None)
    inside, first = total[window[1]] - total[window[0]], moment[window[1]] - moment[window[0]]
    slopes: ComplexArray = first - (number[: len(inside)] + 0.5 * (near + far)) * inside
    return slopes
