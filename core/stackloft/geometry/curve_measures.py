"""Length, area, centroid and canonical start of closed piecewise-cubic curves, by Gauss on each segment."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.curve_figures import curve_figures
from stackloft.geometry.turn_table import COSINES, SINES, cosine_and_sine

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
    rule = _gauss(2 if np.diff(first).min() >= MANY else 4)
    found = curve_figures((p0, p1, d0, d1), first, rule, (COSINES, SINES))
    figures, fractions = _figures(p0, p1, d0, d1, first, rule) if found is None else found
    lengths, areas, straight, *arms, real, imaginary = figures
    starts = -np.arctan2(imaginary, real) / (2.0 * np.pi)
    return CurveMeasures(lengths, areas, straight, (p0[:, first[:-1]] + arms).T, starts, fractions)


@cache
def _gauss(count: int) -> tuple[FloatArray, FloatArray]:
    """Return Gauss's places from 0 to 1 and weights; they are the eigenvalues of a matrix, found once."""
    nodes, weights = (0.5 * each for each in np.polynomial.legendre.leggauss(count))
    return nodes + 0.5, weights


def _figures(
    p0: FloatArray,
    p1: FloatArray,
    d0: FloatArray,
    d1: FloatArray,
    first: IntArray,
    rule: tuple[FloatArray, FloatArray],
) -> tuple[FloatArray, FloatArray]:
    """Return what `curve_figures` does, all segments at once."""
    counts = np.diff(first)
    begin = [np.repeat(each, counts) for each in p0[:, first[:-1]]]
    doubled, moments = np.zeros_like(p0[0]), np.zeros_like(p0)
    points = []
    for t, weight in zip(*rule, strict=True):
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
    return np.stack([lengths, areas, straight, *arms, real, imaginary]), fraction


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
