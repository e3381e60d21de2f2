r"""Corners of loops traced on pixels: found, and put back where the pixels rounded them off.

::

                  x  apex: the two sides, continued, meet here
          . . . /  \ . . .
        side   / __ \   side          what was traced: cut short by the pixels and the median
       ______ /      \ ______
     |<- w ->|g      g|<- w ->|       each side is fitted over w pixels, the g next to the corner left out

Either side is fitted by a parabola in arc length. On a smooth outline the two continue each other; at a
corner their directions differ, whatever the scale, and they meet at the apex. (The two-sided comparison of
Chetverikov & Szabó 1999 and of Teh & Chin 1989, with curves in place of chords, so that a small round
section is not taken for one big corner.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.equal_choices import points_ahead
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import Loop

STEP = 0.5
"""Pixels between the samples that are fitted."""

_SLACK = 1e-6  # degrees: rounding
_SIGNIFICANT = 5.0  # standard errors of the bend; neighbouring samples are correlated, hence not 2


@dataclass(frozen=True, slots=True)
class CornerRules:
    """When a traced loop has a corner; lengths in pixels, angles in degrees."""

    turn: float = 40.0
    """The sides' directions differ by at least this."""
    gap: float = 2.5
    """Length on either side that is rounded off and left out."""
    window: float = 10.0
    """Length of a side that is fitted, at most; a sixteenth of a short loop."""
    shortest: float = 7.0
    """Least length fitted: smaller loops show no corners."""
    roughness: float = 0.25
    """Root mean square distance of a side from its parabola, at most."""
    sudden: float = 0.75
    """Least part of the turn of the sides' chords that is made at the corner itself: above 0.9 for
    straight sides, 0.4 to 0.7 for the tip of an ellipse however sharp."""
    rounding: float = 2.0
    """Distance of the apex from what was traced, at most."""


@dataclass(frozen=True, slots=True, eq=False)
class _Sides:
    """At samples that may be corners, what their two sides say."""

    turn: FloatArray
    """(n) degrees between the sides' directions, signed"""
    chord_turn: FloatArray
    """(n) likewise of straight lines fitted to the sides"""
    apex: FloatArray
    """(n, 2) where the sides' tangents meet"""
    miss: FloatArray
    """(n) distance from apex to sample"""
    roughness: FloatArray
    """(n) the rougher side's distance from its parabola, root mean square"""


def with_corners(loop: Loop, pixel: float, rules: CornerRules | None = None) -> Loop:
    """Return a traced loop with its corners marked and put back at their apex.

    Parameters
    ----------
    loop : Loop
        Traced vertices, about one per pixel, mm.
    pixel : float
        Pixel size, mm.

    Returns
    -------
    Loop
        The same loop when it has no corner. Otherwise the vertices that were rounded off are left out, and
        the apex of each corner stands in their place.

    Examples
    --------
    >>> side = np.arange(-30.0, 30.0)
    >>> ends = np.full(60, 30.0)
    >>> square = np.concatenate([np.column_stack(xy) for xy in
    ...     ((side, -ends), (ends, side), (-side, ends), (-ends, -side))])
    >>> blunt = Loop(square[np.abs(square).sum(axis=1) < 58.5])
    >>> sharp = with_corners(blunt, 1.0)
    >>> np.round(sharp.points[sharp.corners] + 0.0, 9).tolist()
    [[30.0, -30.0], [30.0, 30.0], [-30.0, 30.0], [-30.0, -30.0]]
    """
    rules = rules or CornerRules()
    along = _arc_length(loop.points / pixel)
    count = round(along[-1] / STEP)
    window = min(rules.window, along[-1] / 16)
    if window < rules.shortest:
        return loop
    reach = np.arange(round(rules.gap / STEP), round((rules.gap + window) / STEP) + 1)
    samples = _resampled(loop.points / pixel, along, count)
    turning = _turning(samples, reach, rules.turn)
    if not len(turning):
        return loop
    sides = _sides(samples, turning, reach)
    likely = _likely(sides, rules)
    ahead = points_ahead(samples[turning])
    order = sorted(likely.tolist(), key=lambda k: (round(float(sides.miss[k]), 6), -ahead[k]))
    chosen = _apart(order, turning, count, round(window / STEP))
    if not len(chosen):
        return loop
    places = turning[chosen] * along[-1] / count
    return _sharpened(loop, along, places, pixel * sides.apex[chosen], rules.gap)


def _arc_length(points: FloatArray) -> FloatArray:
    """Return the length from the first vertex to each, and (last) back to the first: (k + 1)."""
    steps = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _resampled(points: FloatArray, along: FloatArray, count: int) -> FloatArray:
    """Return `count` samples, (n, 2), evenly spaced around a closed polygon."""
    closed = np.vstack([points, points[:1]])
    at = np.arange(count) * (along[-1] / count)
    columns = [np.interp(at, along, closed[:, axis]) for axis in (0, 1)]
    return np.column_stack(columns)


def _turning(samples: FloatArray, reach: IntArray, turn: float) -> IntArray:
    """Return the samples at which the straight lines fitted to both sides differ by `turn` degrees or more.

    A line's direction is one filter along the loop; a side behind one sample is the side ahead of another.
    """
    way = np.ascontiguousarray(samples).view(np.complex128)[:, 0]
    slope = np.linalg.pinv(np.vander(STEP * reach.astype(np.float64), 2, increasing=True))[1]
    around = np.concatenate([way, way[: reach[-1]]])
    ahead = np.convolve(around[reach[0] :], slope[::-1], mode="valid")
    behind = np.roll(ahead, reach[0] + reach[-1])
    between = behind.conj() * ahead
    return np.flatnonzero(between.real <= np.cos(np.radians(turn - _SLACK)) * np.abs(between))


def _sides(samples: FloatArray, here: IntArray, reach: IntArray) -> _Sides:
    """Fit both sides of the samples `here`."""
    along = STEP * reach.astype(np.float64)
    ahead = _fitted(samples[(here + reach[:, None]) % len(samples)], along)
    behind = _fitted(samples[(here - reach[:, None]) % len(samples)], along)
    apex = _meeting(ahead.point, ahead.direction, behind.point, behind.direction)
    return _Sides(
        turn=_angle(-behind.direction, ahead.direction),
        chord_turn=_angle(-behind.chord, ahead.chord),
        apex=apex,
        miss=np.linalg.norm(apex - samples[here], axis=1),
        roughness=np.maximum(ahead.roughness, behind.roughness),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Fit:
    """A side's curve, continued to the sample it starts from; (n, 2) each, roughness (n)."""

    point: FloatArray
    direction: FloatArray
    chord: FloatArray
    """Direction of the straight line fitted to the side."""
    roughness: FloatArray


def _fitted(side: FloatArray, u: FloatArray) -> _Fit:
    """Fit a parabola to a side, or a straight line where it is not significantly bent.

    Parameters
    ----------
    side : ndarray, (m, n, 2)
        m points of the side of each of n samples.
    u : ndarray, (m)
        Distance of these from the sample, along the loop.
    """
    basis = np.vander(u, 3, increasing=True)
    solve, straight = np.linalg.pinv(basis), np.linalg.pinv(basis[:, :2])
    flat = side.reshape(len(u), -1)
    bent = (solve @ flat).reshape(3, -1, 2)
    line = (straight @ flat).reshape(2, -1, 2)
    left = ((np.eye(len(u)) - basis @ solve) @ flat).reshape(len(u), -1, 2)
    roughness = np.sqrt(np.sum(left**2, axis=(0, 2)) / (len(u) - 3))
    spread = roughness * np.linalg.norm(solve[2])
    is_bent = (np.linalg.norm(bent[2], axis=1) > _SIGNIFICANT * spread)[:, None]
    return _Fit(np.where(is_bent, bent[0], line[0]), np.where(is_bent, bent[1], line[1]), line[1], roughness)


def _angle(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the signed angle from one direction to another, (n) degrees."""
    cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    degrees: FloatArray = np.degrees(np.arctan2(cross, np.sum(first * second, axis=1)))
    return degrees


def _meeting(start: FloatArray, forth: FloatArray, end: FloatArray, back: FloatArray) -> FloatArray:
    """Return where the lines through `start` along `forth` and `end` along `back` meet; inf if parallel."""
    cross = forth[:, 0] * back[:, 1] - forth[:, 1] * back[:, 0]
    way = end - start
    reach = way[:, 0] * back[:, 1] - way[:, 1] * back[:, 0]
    steps = np.divide(reach, cross, out=np.full(len(cross), np.inf), where=np.abs(cross) > 1e-6)
    with np.errstate(invalid="ignore"):
        meeting: FloatArray = start + steps[:, None] * forth
    return meeting


def _likely(sides: _Sides, rules: CornerRules) -> IntArray:
    """Return the samples whose two sides meet as at a corner."""
    with np.errstate(invalid="ignore"):
        return np.flatnonzero(
            (np.abs(sides.turn) >= rules.turn)
            & (np.abs(sides.chord_turn) >= rules.turn)
            & (sides.turn * np.sign(sides.chord_turn) >= rules.sudden * np.abs(sides.chord_turn))
            & (sides.miss <= rules.rounding)
            & (sides.roughness <= rules.roughness)
        )


def _apart(order: list[int], here: IntArray, count: int, apart: int) -> IntArray:
    """Return which of the samples `here` (of `count`), best first, are corners, in order around the loop."""
    chosen: list[int] = []
    for k in order:
        away = [int(here[k] - here[other]) for other in chosen]
        if all(min(step % count, -step % count) > apart for step in away):
            chosen.append(k)
    return np.array(sorted(chosen), dtype=np.int64)


def _sharpened(loop: Loop, along: FloatArray, places: FloatArray, apices: FloatArray, gap: float) -> Loop:
    """Return the loop with each apex in place of the vertices within `gap` pixels of it."""
    total, at = along[-1], along[:-1]
    distance = np.abs(at[:, None] - places[None, :])
    kept = np.minimum(distance, total - distance).min(axis=1) > gap
    order = np.argsort(np.concatenate([at[kept], places]), kind="stable")
    points = np.concatenate([loop.points[kept], apices])[order]
    corners = np.flatnonzero(order >= int(kept.sum()))
    return Loop(frozen_floats(points), frozen_ints(corners), loop.hole)
