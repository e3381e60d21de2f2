"""Least-squares cubic splines on even knots: the basis in closed form, the normal equations banded.

With knots at whole numbers every B-spline is the same bump, so that collocation needs no recursion; at two
or more points per span the normal equations are well conditioned (de Boor 1978, ch. XIV).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_BUMPS = 4
_POWERS = 7
_BASIS = np.array([[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]]) / 6.0
"""The four bumps on a span, each by powers of the place within it."""
_PRODUCTS = np.array([[np.convolve(a, b) for b in _BASIS] for a in _BASIS])
"""Of every two of them, likewise: (4, 4, 7)."""


def fit_uniform(t: FloatArray, points: FloatArray, spans: int, at: FloatArray) -> FloatArray:
    """Return the least-squares cubic spline with knots 0, 1, … `spans`, evaluated.

    Parameters
    ----------
    t : (n,) array
        Parameters of the points, increasing, in [0, spans]; at least two in every span.
    points : (n, d) array
    spans : int
    at : (k,) array
        Where the spline is wanted.

    Returns
    -------
    (k, d) array

    Examples
    --------
    >>> t = np.linspace(0.0, 5.0, 40)
    >>> cubic = np.stack([t**3 - t, 2 * t**2], axis=1)
    >>> fit_uniform(t, cubic, 5, np.array([0.5, 4.9])).round(6).tolist()
    [[-0.375, 0.5], [112.749, 48.02]]
    """
    return fit_uniform_all([t], points, [spans], [at])[0]


def fit_uniform_all(
    t: Sequence[FloatArray], points: FloatArray, spans: Sequence[int], at: Sequence[FloatArray]
) -> list[FloatArray]:
    """Return several splines as `fit_uniform` gives each, by one solve of all normal equations.

    Parameters
    ----------
    t : sequence of (n_i,) arrays
    points : (Σ n_i, d) array
        Those of the first spline, then those of the second …
    spans : sequence of int
    at : sequence of (k_i,) arrays
    """
    sizes = np.array(spans) + _BUMPS - 1
    offsets, count = np.cumsum(sizes) - sizes, int(sizes.sum())
    moments = _moments(*_placed(t, spans, offsets), points.T, count)
    bands, right = np.zeros((_BUMPS, count)), np.zeros((points.shape[1], count))
    products = np.tensordot(_PRODUCTS, moments[:_POWERS], 1)  # of every two bumps, summed over each span
    values = np.tensordot(_BASIS, moments[_POWERS:].reshape(points.shape[1], _BUMPS, count), (1, 1))
    for a in range(_BUMPS):
        upto = count - a
        for b in range(a, _BUMPS):
            bands[b - a, a:] += products[a, b, :upto]
        right[:, a:] += values[a, :, :upto]
    solved = solveh_banded(
        bands, right.T, lower=True, overwrite_ab=True, overwrite_b=True, check_finite=False
    )
    return np.split(_evaluated(solved.T, *_placed(at, spans, offsets)), np.cumsum([len(x) for x in at])[:-1])


def _placed(
    each: Sequence[FloatArray], spans: Sequence[int], offsets: IntArray
) -> tuple[IntArray, FloatArray]:
    """Return the span in which each t lies, numbered over all splines, and how far in."""
    counts = [len(t) for t in each]
    t = np.concatenate(each)
    first = np.minimum(t.astype(np.int64), np.repeat(spans, counts) - 1)
    x = t - first
    first += np.repeat(offsets, counts)
    return first, x


def _moments(first: IntArray, x: FloatArray, planes: FloatArray, count: int) -> FloatArray:
    """Return Σ xᵏ for k = 0 … 6 over each span, then Σ xᵏ·p for k = 0 … 3 of each coordinate p."""
    rows = np.empty((_POWERS + _BUMPS * len(planes), len(x)))
    rows[0] = 1.0
    for k in range(1, _POWERS):
        np.multiply(rows[k - 1], x, out=rows[k])
    for start, p in zip(range(_POWERS, len(rows), _BUMPS), planes, strict=True):
        np.multiply(rows[:_BUMPS], p, out=rows[start : start + _BUMPS])
    starts = np.flatnonzero(np.diff(first, prepend=-1))
    moments = np.zeros((len(rows), count))
    moments[:, first[starts]] = np.add.reduceat(rows, starts, axis=1)
    return moments


def _evaluated(solved: FloatArray, first: IntArray, x: FloatArray) -> FloatArray:
    """Return Σ solved · bump at the places, (n, d), of solved (d, count)."""
    bumps = np.zeros((_BUMPS, *solved.shape))
    for a in range(_BUMPS):
        bumps[a, :, : solved.shape[1] - a] = solved[:, a:]
    powers = np.tensordot(_BASIS.T, bumps, 1)  # of each span's cubic, (4, d, count)
    values = np.empty((len(x), len(solved)))
    for axis in range(len(solved)):
        c0, c1, c2, c3 = powers[:, axis].take(first, axis=1)
        values[:, axis] = c0 + x * (c1 + x * (c2 + x * c3))
    return values
