"""Traced loops made smooth: least-squares cubic splines through sub-pixel vertices.

A loop traced on pixels has vertices at irregular steps, each misplaced by some hundredths of a pixel.
Interpolated, it would ripple; a least-squares cubic spline with knots several pixels apart follows the
boundary without the shrinkage of a running mean (de Boor 1978, ch. XIV).
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_lsq_spline

from stackloft.geometry.shoelace import polygon_area
from stackloft.geometry.uniform_spline import fit_uniform
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import Loop

KNOT_SPACINGS = (6.0, 4.0, 3.0)
"""Pixels between knots: the widest that keeps the loop's area."""
AREA_KEPT = (0.1, 2e-4)
"""Pixels² and fraction of the loop's area: the larger of the two is what smoothing may change the area by."""
STEP = 1.5
"""Pixels between the vertices returned."""
_DEGREE = 3
_OVERLAP = 10  # spans by which a closed loop is wrapped; what happens at their ends is not felt within
_FEWEST = 2  # vertices in each span, for a fit on even knots


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
    points, marks = _without_repeats(loop.points, loop.corners, 1e-6 * pixel)
    if len(points) < 12:
        return Loop(frozen_floats(points), frozen_ints(marks), loop.hole)
    if len(marks) == 0:
        return Loop(frozen_floats(_area_kept(points, pixel)), loop.corners, loop.hole)
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
    step = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)
    keep = step > least
    keep[marks] = True
    position = np.cumsum(keep) - 1
    return points[keep], np.sort(position[marks])


def _area_kept(points: FloatArray, pixel: float) -> FloatArray:
    """Return a closed loop smoothed, its knots close enough that no tip of it is cut short."""
    area = _curve_area(points)
    least, share = AREA_KEPT
    allowed = max(least * pixel**2, share * abs(area))
    for spacing in KNOT_SPACINGS:
        smooth = _smooth_closed(points, spacing * pixel, STEP * pixel)
        if abs(_curve_area(smooth) - area) <= allowed:
            break
    return smooth


def _curve_area(points: FloatArray) -> float:
    """Return what a smooth closed curve through the points encloses: the polygon and what its chords miss.

    A chord of length L cuts off κL³/12; around a curve that turns once that makes π/6 times the mean L².
    """
    polygon = polygon_area(points)
    squared = float(((np.roll(points, -1, axis=0) - points) ** 2).sum(axis=1).mean())
    return polygon + float(np.copysign(np.pi / 6.0 * squared, polygon))


def _smooth_closed(points: FloatArray, spacing: float, step: float) -> FloatArray:
    """Return a closed loop smoothed: overlapped with itself, fitted as an open arc, cut back."""
    chord = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    around = np.concatenate([[0.0], np.cumsum(chord)])
    total = around[-1]
    spans = max(4, _at_most(total / spacing, len(points) // 2))
    count = max(16, _at_most(total / step, 2 * len(points)))
    samples: FloatArray = np.arange(count) * np.float64(spans / count)
    overlap = min(_OVERLAP, spans)
    t = around[:-1] * (spans / total)
    before, after = np.searchsorted(t, [spans - overlap, overlap])
    t = np.concatenate([t[before:] - spans, t, t[:after] + spans])
    wrapped = np.concatenate([points[before:], points, points[:after]])
    if np.bincount((t + overlap).astype(np.int64), minlength=spans + 2 * overlap).min() >= _FEWEST:
        return fit_uniform(t + overlap, wrapped, spans + 2 * overlap, samples + overlap)
    return _fit(t, wrapped, np.arange(1 - overlap, spans + overlap, dtype=np.float64), samples)


def _smooth_arc(points: FloatArray, pixel: float) -> FloatArray:
    """Return an open arc smoothed; its end points stay."""
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    t = np.concatenate([[0.0], np.cumsum(chord)])
    total = t[-1]
    count = max(2, _at_most(total / (STEP * pixel), 2 * len(points)))
    samples = np.linspace(0.0, total, count + 1)
    if len(points) < 8:
        return np.column_stack([np.interp(samples, t, axis) for axis in points.T])
    spans = max(1, _at_most(total / (KNOT_SPACINGS[0] * pixel), len(points) // 2))
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
