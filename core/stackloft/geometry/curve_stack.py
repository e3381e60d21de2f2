"""One closed curve per section, all evaluated together.

A curve is the piecewise cubic through its loop's points: C² between corners, broken at them. The curves
of a stack share one parameter g = section + s, where s in [0, 1) is the fraction of arc length from the
curve's *canonical start*, which depends on the curve's shape alone and not on the vertex it was given
from: the phase of the first Fourier coefficient of the curve (Kuhl & Giardina 1982).
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.arc_splines import WRAP, spline_tangents

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

THREADS = 2
"""Threads that fit curves, where there are many."""
AT_ONCE = 16_000
"""Vertices worked on at once, so that what is in between stays in the processor's cache."""
_JOINED = ("points", "ends", "leaving", "arriving", "lengths", "starts", "centroids", "areas")
MANY = 128
"""Vertices from which on a loop's segments are so short that two Gauss points on each do for four."""


@dataclass(frozen=True, slots=True, eq=False)
class CurveStack:
    """Closed piecewise-cubic curves, one per section."""

    points: FloatArray
    """(n, 2) mm: segment starts, section after section."""
    ends: FloatArray
    """(n, 2) mm: segment ends."""
    leaving: FloatArray
    """(n, 2) dP/dx at segment starts, x in [0, 1] along the segment."""
    arriving: FloatArray
    """(n, 2) dP/dx at segment ends."""
    knots: FloatArray
    """(n + 1,) global parameter of the segment starts, increasing, from first[0] to the last end."""
    first: IntArray
    """(m + 1,) first segment of each section."""
    lengths: FloatArray
    """(m,) mm: perimeters."""
    starts: FloatArray
    """(m,) arc-length fraction, from the first vertex, of the canonical start."""
    centroids: FloatArray
    """(m, 2) mm: area centroids."""
    areas: FloatArray
    """(m,) mm²"""

    def __len__(self) -> int:
        return len(self.lengths)

    def at(self, section: IntArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return points and unit-fraction derivatives on the curves.

        Parameters
        ----------
        section : int array, broadcastable with `s`
            Section numbers.
        s : array
            Fractions of arc length from each canonical start (any real number; wraps).

        Returns
        -------
        points : (..., 2) array, mm
        derivative : (..., 2) array
            dP/ds, mm; its length is close to the perimeter.
        """
        g = section + np.mod(s + self.starts[section], 1.0)
        # rounding can carry g to the next section's first knot: hold it to its own section
        index = np.searchsorted(self.knots, g, side="right") - 1
        index = np.clip(index, self.first[section], self.first[section + 1] - 1)
        span = self.knots[index + 1] - self.knots[index]
        x = (g - self.knots[index]) / span
        p0, p1, d0, d1 = (each[index] for each in (self.points, self.ends, self.leaving, self.arriving))
        point, slope = np.empty((*x.shape, 2)), np.empty((*x.shape, 2))
        for k in (0, 1):  # a coordinate at a time: rows of two take several times as long
            point[..., k], along = _along(p0[..., k], p1[..., k], d0[..., k], d1[..., k], x)
            np.divide(along, span, out=slope[..., k])
        return point, slope

    def flipped(self, flip: tuple[float, float]) -> CurveStack:
        """Return the curves with x and y multiplied by 1 or -1, counter-clockwise again.

        In one mirror each runs the other way from the same vertex; its canonical start is the mirrored one
        (y alone), or half a loop from that, since it lies to the right of the middle.
        """
        scale = np.array(flip)
        half = 0.0 if flip[0] > 0.0 else 0.5
        centroids = self.centroids * scale
        if flip[0] * flip[1] > 0.0:
            return replace(
                self,
                points=self.points * scale,
                ends=self.ends * scale,
                leaving=self.leaving * scale,
                arriving=self.arriving * scale,
                starts=self.starts + half,
                centroids=centroids,
            )
        section = np.repeat(np.arange(len(self)), np.diff(self.first))
        back = (self.first[:-1] + self.first[1:] - 1)[section] - np.arange(len(section))
        passed = np.append(2 * section + 1 - self.knots[1:][back], float(len(self)))
        return replace(
            self,
            points=self.ends[back] * scale,
            ends=self.points[back] * scale,
            leaving=-self.arriving[back] * scale,
            arriving=-self.leaving[back] * scale,
            knots=passed,
            starts=half - self.starts,
            centroids=centroids,
        )


def fit_curves(loops: list[FloatArray], corners: list[IntArray]) -> CurveStack:
    """Return the interpolating closed curves of one loop per section.

    Parameters
    ----------
    loops : list of (k_i, 2) arrays
        Vertices, mm, counter-clockwise, no repeated end point, no two neighbours equal.
    corners : list of (c_i,) int arrays
        Vertices at which the curve may turn sharply.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(80) / 80
    >>> curves = fit_curves([np.stack([np.cos(t), np.sin(t)], axis=1)], [np.array([], dtype=int)])
    >>> bool(abs(curves.areas[0] - np.pi) < 1e-6)
    True
    """
    counts = np.array([len(loop) for loop in loops])
    first = np.concatenate([[0], np.cumsum(counts)])
    cuts = [0, *(np.flatnonzero(np.diff(first[1:-1] // AT_ONCE)) + 1), len(loops)]

    def fitted(cut: tuple[int, int]) -> CurveStack:
        some = slice(*cut)
        own = first[cut[0] : cut[1] + 1] - first[cut[0]]
        return _with_measures(*_hermite_segments(loops[some], corners[some]), own)

    if len(cuts) == 2:
        return fitted((0, len(loops)))
    with ThreadPoolExecutor(THREADS, thread_name_prefix="stackloft-curves") as pool:
        parts = list(pool.map(fitted, pairwise(cuts)))
    joined = {name: np.concatenate([getattr(part, name) for part in parts]) for name in _JOINED}
    knots = [part.knots[:-1] + a for part, a in zip(parts, cuts, strict=False)]
    return CurveStack(knots=np.append(np.concatenate(knots), float(len(loops))), first=first, **joined)


def _hermite_segments(
    loops: list[FloatArray], corners: list[IntArray]
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the segments' end points and end tangents, loop after loop, vertex after vertex."""
    pieces, arc_starts, leaving_at, order = [], [], [], []
    total, base = 0, 0
    for loop, marks in zip(loops, corners, strict=True):
        k = len(loop)
        for index, inner in _arcs(k, marks):
            arc_starts.append(total)
            leaving_at.append(total + inner)
            order.append(base + index[inner] % k)
            pieces.append(loop.take(index, axis=0, mode="wrap"))
            total += len(index)
        base += k
    points = np.concatenate(pieces)
    x, y = np.diff(points.T)
    chord = np.sqrt(x * x + y * y)
    nodes = np.concatenate([[0.0], np.cumsum(np.maximum(chord, 1e-300))])
    tangents = spline_tangents(nodes, points, np.array(arc_starts))
    at, back = np.concatenate(leaving_at), np.concatenate(order)
    p0, p1, d0, d1 = (np.empty((base, 2)) for _ in range(4))
    p0[back], p1[back] = points[at], points[at + 1]
    length = chord[at]
    for k in (0, 1):
        d0[back, k], d1[back, k] = tangents[at, k] * length, tangents[at + 1, k] * length
    return p0, p1, d0, d1


def _arcs(k: int, marks: IntArray) -> list[tuple[IntArray, IntArray]]:
    """Return (vertex numbers, positions of the segments that count) of each arc of a loop."""
    if len(marks) == 0:
        wrap = min(WRAP, 4 * k)
        return [(np.arange(-wrap, k + wrap + 1), np.arange(wrap, wrap + k))]
    ordered = np.sort(marks)
    following = np.append(ordered[1:], ordered[0] + k)
    return [(np.arange(a, b + 1), np.arange(b - a)) for a, b in zip(ordered, following, strict=True)]


def _with_measures(
    p0: FloatArray, p1: FloatArray, d0: FloatArray, d1: FloatArray, first: IntArray
) -> CurveStack:
    """Return the stack with perimeters, areas, centroids and canonical starts, by Gauss per segment."""
    x, w = np.polynomial.legendre.leggauss(2 if np.diff(first).min() >= MANY else 4)
    t, weight = 0.5 * (x[:, None] + 1.0), 0.5 * w[:, None]
    section = np.repeat(np.arange(len(first) - 1), np.diff(first))
    origin = p0[first[:-1]]
    a, b, c, d = (np.ascontiguousarray(each.T) for each in (p0, p1, d0, d1))
    place, slope = zip(*(_along(a[k], b[k], c[k], d[k], t) for k in (0, 1)), strict=True)
    local = [place[k] - origin[section, k] for k in (0, 1)]
    cross = weight * (local[0] * slope[1] - local[1] * slope[0])
    areas = 0.5 * np.add.reduceat(cross.sum(axis=0), first[:-1])
    moment = np.stack([(cross * local[k]).sum(axis=0) for k in (0, 1)], axis=1)
    arms = np.add.reduceat(moment, first[:-1]) / (3.0 * areas[:, None])
    centroids = origin + arms
    speed = weight * np.sqrt(slope[0] ** 2 + slope[1] ** 2)
    segment = speed.sum(axis=0)
    lengths = np.add.reduceat(segment, first[:-1])
    before = np.concatenate([[0.0], np.cumsum(segment)])[:-1]
    fraction = (before - before[first[:-1]][section]) / lengths[section]
    # first Fourier coefficient of the curve; its phase is the canonical start (Kuhl & Giardina 1982)
    turn = 2.0 * np.pi * (fraction + t * (segment / lengths[section]))
    cosine, sine = speed * np.cos(turn), speed * np.sin(turn)
    x, y = (local[k] - arms[section, k] for k in (0, 1))
    real = np.add.reduceat((x * cosine + y * sine).sum(axis=0), first[:-1])
    imaginary = np.add.reduceat((y * cosine - x * sine).sum(axis=0), first[:-1])
    starts = -np.arctan2(imaginary, real) / (2.0 * np.pi)
    knots = np.append(section + fraction, float(len(lengths)))
    return CurveStack(p0, p1, d0, d1, knots, first, lengths, starts, centroids, areas)


def _along(
    p0: FloatArray, p1: FloatArray, d0: FloatArray, d1: FloatArray, t: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return one coordinate of the cubics and its slope at t, (g, n) for (g, 1) t."""
    rise = p1 - p0
    a, b = d0 - rise, rise - d1
    bend = a + t * (b - a)
    bow = t * (1.0 - t)
    return p0 + t * rise + bow * bend, rise + (1.0 - 2.0 * t) * bend + bow * (b - a)
