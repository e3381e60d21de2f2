"""Traced loops made smooth: least-squares cubic splines through sub-pixel vertices.

A loop traced on pixels has vertices at irregular steps, each misplaced by some hundredths of a pixel.
Interpolated, it would ripple; a least-squares cubic spline with knots several pixels apart follows the
boundary without the shrinkage of a running mean (de Boor 1978, ch. XIV).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_lsq_spline

from stackloft.compiled.smooth_curve import smooth_closed
from stackloft.geometry.shoelace import polygon_area
from stackloft.geometry.simple_polygon import is_entangled
from stackloft.geometry.uniform_spline import fit_uniform_all
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, frozen_ints, read_only
from stackloft.model.contour_stack import Loop

KNOT_SPACING = 6.0
"""Pixels between knots."""
CLOSER = (4.0, 3.0)
"""Likewise where these would cut tips short."""
WIDER = (9.0, 13.0, 19.0)
"""Likewise where the loop is so jagged that the spline would cross itself."""
FEW = 600
"""Vertices up to which a loop's knots are chosen: on larger ones no tip is small enough to matter."""
AREA_KEPT = (0.1, 2e-4)
"""Pixels² and fraction of the loop's area: the larger of the two is what smoothing may change the area by."""
FEWEST = 8
"""Spans of a closed loop, however small. Four turn an oval of a few pixels into a rounder one: they cannot
tell its third harmonic from its first, which alone cost 0.4 % of the area of a body 9 × 7 pixels across."""
STEP = 1.5
"""Pixels between the vertices returned."""
_DEGREE = 3
_ROUND = 4  # spans that a closed curve needs at least
_OVERLAP = 10  # spans by which a closed loop is wrapped; what happens at their ends is not felt within
_IN_EACH = 2  # vertices in each span, for a fit on even knots
_SHORTEST = 12  # vertices; a loop of fewer is not smoothed
_TOGETHER = 8  # loops fitted at once, so that what is in between stays in the processor's cache


def smooth_loop(loop: Loop, pixel: float) -> Loop:
    """Return the loop as a least-squares spline, sampled evenly; corners stay where they are.

    Parameters
    ----------
    loop : Loop
        Traced vertices, about one per pixel edge crossed.
    pixel : float
        Pixel size, mm.

    Returns
    -------
    Loop
        Vertices about 1.5 pixels apart. A loop too short to smooth is returned as it is.
    """
    return smooth_loops([loop], pixel)[0]


def smooth_loops(loops: Sequence[Loop], pixel: float) -> list[Loop]:
    """Return several loops as `smooth_loop` does each; together they take less time."""
    bare = [_without_repeats(loop.points, loop.corners, 1e-6 * pixel) for loop in loops]
    closed = [k for k, (points, marks) in enumerate(bare) if len(points) >= _SHORTEST and not len(marks)]
    smoothed = iter(_all_smooth_closed([bare[k][0] for k in closed], pixel))
    around = set(closed)
    return [
        Loop(read_only(next(smoothed)), loop.corners, loop.hole)
        if k in around
        else _smooth_arcs(points, marks, loop, pixel)
        for k, (loop, (points, marks)) in enumerate(zip(loops, bare, strict=True))
    ]


def _smooth_arcs(points: FloatArray, marks: IntArray, loop: Loop, pixel: float) -> Loop:
    """Return a loop smoothed between its corners, or as it is when it is too short."""
    if len(points) < _SHORTEST:
        return Loop(frozen_floats(points), frozen_ints(marks), loop.hole)
    pieces, starts, total = [], [], 0
    following = np.append(marks[1:], marks[0] + len(points))
    for a, b in zip(marks, following, strict=True):
        piece = _smooth_arc(points[np.arange(a, b + 1) % len(points)], pixel)[:-1]
        starts.append(total)
        total += len(piece)
        pieces.append(piece)
    return Loop(frozen_floats(np.concatenate(pieces)), frozen_ints(starts), loop.hole)


def _without_repeats(points: FloatArray, marks: IntArray, least: float) -> tuple[FloatArray, IntArray]:
    """Return the vertices without those closer than `least` to the one before; corners are kept."""
    keep = chords(points) > least
    if keep.all():
        return points, np.sort(marks)
    keep = np.concatenate([keep[-1:], keep[:-1]])  # the chord that arrives
    keep[marks] = True
    position = np.cumsum(keep) - 1
    return points[keep], np.sort(position[marks])


def chords(points: FloatArray) -> FloatArray:
    """Return the distance from each vertex of a closed polygon to the next one."""
    place = np.ascontiguousarray(points).view(np.complex128)[:, 0]  # rows of two take twice as long
    step = np.empty_like(place)
    np.subtract(place[1:], place[:-1], out=step[:-1])
    step[-1] = place[0] - place[-1]
    return np.abs(step)


@dataclass(frozen=True, slots=True, eq=False)
class _Wrapped:
    """A closed loop overlapped with itself, to be fitted as an open arc and cut back."""

    t: FloatArray
    """Parameters of the vertices, knots at whole numbers, from 0."""
    points: FloatArray
    spans: int
    samples: FloatArray
    """Where the smoothed vertices are."""

    @staticmethod
    def of(points: FloatArray, spacing: float, step: float, fewest: int = FEWEST) -> _Wrapped:
        around = np.concatenate([[0.0], np.cumsum(chords(points))])
        total = around[-1]
        spans = max(_ROUND, _at_most(max(total / spacing, fewest), len(points) // 2))
        count = max(16, _at_most(total / step, 2 * len(points)))
        overlap = min(_OVERLAP, spans)
        t = around[:-1] * (spans / total)
        before, after = np.searchsorted(t, [spans - overlap, overlap])
        t = np.concatenate([t[before:] - spans, t, t[:after] + spans])
        wrapped = np.concatenate([points[before:], points, points[:after]])
        samples: FloatArray = np.arange(count) * np.float64(spans / count)
        return _Wrapped(t + overlap, wrapped, spans + 2 * overlap, samples + overlap)

    def is_even(self) -> bool:
        """Return whether every span has vertices enough for a fit on even knots."""
        return bool(np.bincount(self.t.astype(np.int64), minlength=self.spans).min() >= _IN_EACH)


def _all_smooth_closed(loops: Sequence[FloatArray], pixel: float) -> list[FloatArray]:
    """Return closed loops smoothed, their knots chosen one by one where the usual ones do not serve."""
    usual = _fitted_with(loops, KNOT_SPACING, pixel)
    return [
        smooth if len(points) > FEW else _with_chosen_knots(points, smooth, pixel)
        for points, smooth in zip(loops, usual, strict=True)
    ]


def _fitted_with(
    loops: Sequence[FloatArray], spacing: float, pixel: float, fewest: int = FEWEST
) -> list[FloatArray]:
    """Return closed loops as splines with such knots, by the compiled kernel where it can."""
    fitted = smooth_closed(loops, spacing * pixel, STEP * pixel, fewest)
    rest = [points for points, smooth in zip(loops, fitted, strict=True) if smooth is None]
    others = iter(
        _all_fitted([_Wrapped.of(points, spacing * pixel, STEP * pixel, fewest) for points in rest])
    )
    return [next(others) if smooth is None else smooth for smooth in fitted]


def _with_chosen_knots(points: FloatArray, usual: FloatArray, pixel: float) -> FloatArray:
    """Return a loop smoothed so that no tip of it is cut short, and it does not cross itself."""
    if is_entangled(usual):
        wider = (_fitted_with([points], spacing, pixel, _ROUND)[0] for spacing in WIDER)
        return next((smooth for smooth in wider if not is_entangled(smooth)), usual)
    area = _curve_area(points)
    least, share = AREA_KEPT
    allowed = max(least * pixel**2, share * abs(area))
    best, least_off = usual, abs(_curve_area(usual) - area)
    for spacing in CLOSER:
        if least_off <= allowed:
            break
        smooth = _fitted_with([points], spacing, pixel)[0]
        off = abs(_curve_area(smooth) - area)
        if off < least_off and not is_entangled(smooth):
            best, least_off = smooth, off
    return best


def _curve_area(points: FloatArray) -> float:
    """Return what a smooth closed curve through the points encloses: the polygon and what its chords miss.

    A chord of length L cuts off κL³/12; around a curve that turns once that makes π/6 times the mean L².
    """
    polygon = polygon_area(points)
    return polygon + float(np.copysign(np.pi / 6.0 * (chords(points) ** 2).mean(), polygon))


def _all_fitted(wrapped: Sequence[_Wrapped]) -> list[FloatArray]:
    """Return the splines through loops, a few loops at once where their knots are even."""
    even = [one for one in wrapped if one.is_even()]
    fitted: dict[int, FloatArray] = {}
    for start in range(0, len(even), _TOGETHER):
        some = even[start : start + _TOGETHER]
        points = np.concatenate([one.points for one in some])
        smooth = fit_uniform_all(
            [one.t for one in some], points, [one.spans for one in some], [one.samples for one in some]
        )
        fitted |= {id(one): own for one, own in zip(some, smooth, strict=True)}
    return [fitted[id(one)] if id(one) in fitted else _fit_uneven(one) for one in wrapped]


def _fit_uneven(one: _Wrapped) -> FloatArray:
    return _fit(one.t, one.points, np.arange(1, one.spans, dtype=np.float64), one.samples)


def _smooth_arc(points: FloatArray, pixel: float) -> FloatArray:
    """Return an open arc smoothed; its end points stay."""
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    t = np.concatenate([[0.0], np.cumsum(chord)])
    total = t[-1]
    count = max(2, _at_most(total / (STEP * pixel), 2 * len(points)))
    samples = np.linspace(0.0, total, count + 1)
    if len(points) < 8:
        return np.column_stack([np.interp(samples, t, axis) for axis in points.T])
    spans = max(1, _at_most(total / (KNOT_SPACING * pixel), len(points) // 2))
    knots = np.linspace(0.0, total, spans + 1)[1:-1]
    fitted = _fit(t, points, knots, samples, pinned=True)
    fitted[0], fitted[-1] = points[0], points[-1]
    return fitted


def _at_most(wanted: float, most: int) -> int:
    """Return a count, bounded by what the vertices can carry when they lie further apart than pixels."""
    return round(min(wanted, float(most)))


def _fit(
    t: FloatArray, points: FloatArray, knots: FloatArray, samples: FloatArray, *, pinned: bool = False
) -> FloatArray:
    """Return the least-squares cubic spline with the given inner knots at the samples."""
    knots = _supported(t, knots)
    full = np.concatenate([np.full(_DEGREE + 1, t[0]), knots, np.full(_DEGREE + 1, t[-1])])
    weights = np.ones(len(t))
    if pinned:
        weights[[0, -1]] = 100.0
    return np.asarray(make_lsq_spline(t, points, full, k=_DEGREE, w=weights)(samples))


def _supported(t: FloatArray, knots: FloatArray) -> FloatArray:
    """Return the knots with at least two data points between neighbours (Schoenberg & Whitney 1953)."""
    counts = np.searchsorted(t, knots)
    kept, last = [], 0
    for knot, count in zip(knots, counts, strict=True):
        if count - last >= 2 and len(t) - count >= 2:
            kept.append(knot)
            last = count
    return np.array(kept)
