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


def fit_uniform(t: FloatArray, points: FloatArray, spans: int, at: FloatArray) -> FloatArray:
    """Return the least-squares cubic spline with knots 0, 1, … `spans`, evaluated.

    Parameters
    ----------
    t : (n,) array
        Parameters of the points, in [0, spans]; at least two in every span.
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
    first, weights = _basis(t, spans, offsets)
    bands = np.zeros((_BUMPS, count))
    right = np.zeros((count, points.shape[1]))
    for a in range(_BUMPS):
        for b in range(a, _BUMPS):
            bands[b - a] += np.bincount(first + a, weights[a] * weights[b], minlength=count)
        for axis in range(points.shape[1]):
            right[:, axis] += np.bincount(first + a, weights[a] * points[:, axis], minlength=count)
    solved = solveh_banded(bands, right, lower=True, overwrite_ab=True, overwrite_b=True, check_finite=False)
    first, weights = _basis(at, spans, offsets)
    values: FloatArray = weights[0][:, None] * solved[first]
    for a in range(1, _BUMPS):
        values += weights[a][:, None] * solved[first + a]
    return np.split(values, np.cumsum([len(wanted) for wanted in at])[:-1])


def _basis(
    each: Sequence[FloatArray], spans: Sequence[int], offsets: IntArray
) -> tuple[IntArray, FloatArray]:
    """Return the first of the four B-splines that are not zero at each t, and their values, (4, n)."""
    counts = [len(t) for t in each]
    t = np.concatenate(each)
    first = np.minimum(t.astype(np.int64), np.repeat(spans, counts) - 1)
    x = t - first
    y = 1.0 - x
    weights = np.stack([y * y * y, 4.0 - 3.0 * x * x * (1.0 + y), 4.0 - 3.0 * y * y * (1.0 + x), x * x * x])
    weights /= 6.0
    first += np.repeat(offsets, counts)
    return first, weights
