"""Length, area, centroid and canonical start of closed piecewise-cubic curves, by Gauss on each segment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.turn_table import cosine_and_sine

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MANY = 128
"""Vertices from which on a loop's segments are so short that two Gauss points on each do for four."""


@dataclass(frozen=True, slots=True, eq=False)
class CurveMeasures:
    """Figures of m closed curves."""

    lengths: FloatArray
    """(m,) mm"""
    areas: FloatArray
    """(m,) mm²"""
    polygon_areas: FloatArray
    """(m,) mm²: of the polygons through the curves' points."""
    centroids: FloatArray
    """(m, 2) mm: area centroids."""
    starts: FloatArray
    """(m,) arc-length fraction, from the first vertex, of the canonical start."""
    fractions: FloatArray
    """(n,) arc-length fraction of its loop at which each segment starts."""


def curve_measures(
    p0: FloatArray, p1: FloatArray, d0: FloatArray, d1: FloatArray, first: IntArray
) -> CurveMeasures:
    """Return the figures of closed curves.

    Parameters
    ----------
    p0, p1, d0, d1 : (2, n) arrays
        Starts, ends, and dP/dx at both, of all curves' segments, mm.
    first : (m + 1,) int array
        First segment of each curve; the fewest decide the rule, see `MANY`.
    """
    counts = np.diff(first)
    nodes, weights = (
        0.5 * each for each in np.polynomial.legendre.leggauss(2 if counts.min() >= MANY else 4)
    )
    origin = p0[:, first[:-1]]
    begin = [np.repeat(each, counts) for each in origin]
    doubled, moments = np.zeros_like(p0[0]), np.zeros_like(p0)
    points = []
    for t, weight in zip(nodes + 0.5, weights, strict=True):
        (x, along), (y, up) = (along_cubics(p0[k], p1[k], d0[k], d1[k], t) for k in (0, 1))
        x -= begin[0]
        y -= begin[1]
        cross = weight * (x * up - y * along)
        doubled += cross
        moments[0] += cross * x
        moments[1] += cross * y
        points.append((t, x, y, weight * _length(along, up)))
    cross = (p0[0] - begin[0]) * (p1[1] - begin[1]) - (p0[1] - begin[1]) * (p1[0] - begin[0])
    straight = 0.5 * np.add.reduceat(cross, first[:-1])
    areas = 0.5 * np.add.reduceat(doubled, first[:-1])
    arms = np.add.reduceat(moments, first[:-1], axis=1) / (3.0 * areas)
    segment = sum(speed for *_, speed in points)
    lengths = np.add.reduceat(segment, first[:-1])
    before = np.concatenate([[0.0], np.cumsum(segment)])[:-1]
    share = np.repeat(1.0 / lengths, counts)
    fraction = (before - np.repeat(before[first[:-1]], counts)) * share
    # first Fourier coefficient of the curve; its phase is the canonical start (Kuhl & Giardina 1982)
    centre, coefficient = [np.repeat(each, counts) for each in arms], np.zeros_like(p0)
    segment *= share
    for t, x, y, speed in points:
        cosine, sine = cosine_and_sine(fraction + t * segment)
        right, up = x - centre[0], y - centre[1]
        coefficient[0] += speed * (right * cosine + up * sine)
        coefficient[1] += speed * (up * cosine - right * sine)
    real, imaginary = np.add.reduceat(coefficient, first[:-1], axis=1)
    starts = -np.arctan2(imaginary, real) / (2.0 * np.pi)
    return CurveMeasures(lengths, areas, straight, (origin + arms).T, starts, fraction)


def _length(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return √(x² + y²); both are lost."""
    x *= x
    y *= y
    x += y
    return np.asarray(np.sqrt(x, out=x))


def along_cubics(
    p0: FloatArray, p1: FloatArray, d0: FloatArray, d1: FloatArray, t: FloatArray | float
) -> tuple[FloatArray, FloatArray]:
    """Return one coordinate of Hermite cubics and its slope at t.

    Parameters
    ----------
    p0, p1, d0, d1 : arrays
        Value at the start and at the end, slope at both.
    t : array, or float
        From 0 to 1.
    """
    rise = p1 - p0
    skew = rise - d1
    skew -= d0
    skew += rise
    bend = skew * t
    bend += d0
    bend -= rise
    bow = t * (1.0 - t)
    point = rise * t
    point += p0
    point += bow * bend
    skew *= bow
    bend *= 1.0 - 2.0 * t
    rise += bend
    rise += skew
    return point, rise
