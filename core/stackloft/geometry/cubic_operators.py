"""Cubic-spline differentiation as matrices: tangents at the nodes are linear in the points.

Written as matrices, one small solve serves every coordinate of every column of a skin at once.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from stackloft.geometry.arc_splines import end_derivative_weights

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


def periodic_tangents(step: FloatArray) -> FloatArray:
    """Return T (n, n) with T @ f the tangents of the periodic cubic spline through f.

    Parameters
    ----------
    step : (n,) array
        Parameter steps; the last leads from node n - 1 back to node 0.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(24) / 24
    >>> bool(abs(periodic_tangents(np.full(24, t[1])) @ np.sin(t) - np.cos(t)).max() < 1e-4)
    True
    """
    n = len(step)
    left, right = np.zeros((n, n)), np.zeros((n, n))
    i = np.arange(n)
    before, after = np.roll(step, 1), step
    left[i, i] += 2.0 * (before + after)
    np.add.at(left, (i, (i - 1) % n), after)
    np.add.at(left, (i, (i + 1) % n), before)
    right[i, i] += 3.0 * (after / before - before / after)
    np.add.at(right, (i, (i - 1) % n), -3.0 * after / before)
    np.add.at(right, (i, (i + 1) % n), 3.0 * before / after)
    return np.asarray(np.linalg.solve(left, right))


@lru_cache(maxsize=32)
def even_tangents(count: int) -> FloatArray:
    """Return `periodic_tangents` for `count` unit steps, solved once and read-only."""
    tangents = periodic_tangents(np.ones(count))
    tangents.setflags(write=False)
    return tangents


def open_tangents(nodes: FloatArray, given: tuple[bool, bool] = (False, False)) -> FloatArray:
    """Return T (n, n + 2) with T @ [f; f'(first), f'(last)] the tangents of an open cubic spline.

    Parameters
    ----------
    nodes : (n,) array
        Increasing parameter values, n ≥ 2.
    given : pair of bool
        Whether the end tangent is taken from the right-hand side; otherwise it is that of the
        polynomial through the nearest ≤ 4 points, and the column for it is zero.

    Examples
    --------
    >>> t = np.array([0.0, 1.0, 3.0, 4.0, 6.0])
    >>> (open_tangents(t) @ np.append(t**3, [0, 0])).round(9)
    array([  0.,   3.,  27.,  48., 108.])
    """
    n = len(nodes)
    step = np.diff(nodes)
    left, right = np.zeros((n, n)), np.zeros((n, n + 2))
    i = np.arange(1, n - 1)
    before, after = step[:-1], step[1:]
    left[i, i], left[i, i - 1], left[i, i + 1] = 2.0 * (before + after), after, before
    right[i, i - 1] = -3.0 * after / before
    right[i, i + 1] = 3.0 * before / after
    right[i, i] = 3.0 * (after / before - before / after)
    left[0, 0] = left[-1, -1] = 1.0
    count = min(4, n)
    if given[0]:
        right[0, n] = 1.0
    else:
        right[0, :count] = end_derivative_weights(nodes[None, :count])[0]
    if given[1]:
        right[-1, n + 1] = 1.0
    else:
        right[-1, n - 1 :: -1][:count] = end_derivative_weights(nodes[None, ::-1][:, :count])[0]
    return np.asarray(np.linalg.solve(left, right))


def broken_periodic_tangents(step: FloatArray, breaks: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Return (arriving, leaving) tangent matrices (n, n) of a closed spline broken at some nodes.

    Parameters
    ----------
    step : (n,) array
        Parameter steps round the loop.
    breaks : (n,) bool array
        Nodes where the curve may turn sharply (knot multiplicity 3).

    Examples
    --------
    >>> corner = np.array([True, False, True, False])
    >>> arriving, leaving = broken_periodic_tangents(np.ones(4), corner)
    >>> hat = np.array([0.0, 1.0, 2.0, 1.0])
    >>> (arriving @ hat).round(12), (leaving @ hat).round(12)
    (array([-1.,  1.,  1., -1.]), array([ 1.,  1., -1., -1.]))
    """
    n = len(step)
    if not breaks.any():
        both = even_tangents(n) if (step == 1.0).all() else periodic_tangents(step)
        return both, both
    arriving, leaving = np.zeros((n, n)), np.zeros((n, n))
    marks = np.flatnonzero(breaks)
    for a, b in zip(marks, np.append(marks[1:], marks[0] + n), strict=True):
        index = np.arange(a, b + 1)
        nodes = np.concatenate([[0.0], np.cumsum(step[index[:-1] % n])])
        operator = open_tangents(nodes)[:, :-2]
        rows, columns = np.ix_(index % n, index % n)
        leaving_rows = rows[:-1]
        np.add.at(leaving, (leaving_rows, columns), operator[:-1])
        np.add.at(arriving, (rows[1:], columns), operator[1:])
    return arriving, leaving


def tangents_across(
    nodes: FloatArray,
    breaks: BoolArray,
    values: FloatArray,
    slopes: tuple[FloatArray | None, FloatArray | None] = (None, None),
) -> tuple[FloatArray, FloatArray]:
    """Return (arriving, leaving) tangents (n, k) at the nodes of open splines broken at some of them.

    Parameters
    ----------
    nodes : (n,) array
        Increasing parameter values.
    breaks : (n,) bool array
        Inner nodes where the curves may turn sharply.
    values : (n, k) array
        Of k curves.
    slopes : pair of (k,) arrays or None
        Tangents given at the first and last node.

    Examples
    --------
    >>> roof = np.array([[0.0], [1.0], [0.0]])
    >>> arriving, leaving = tangents_across(np.arange(3.0), np.array([False, True, False]), roof)
    >>> float(arriving[1, 0]), float(leaving[1, 0])
    (1.0, -1.0)
    """
    n = len(nodes)
    arriving, leaving = np.empty_like(values), np.empty_like(values)
    marks = np.unique(np.concatenate([[0], np.flatnonzero(breaks), [n - 1]]))
    for a, b in pairwise(marks):
        outer = (slopes[0] if a == 0 else None, slopes[1] if b == n - 1 else None)
        tangents = _open_spline_tangents(nodes[a : b + 1], values[a : b + 1], outer)
        leaving[a:b], arriving[a + 1 : b + 1] = tangents[:-1], tangents[1:]
    arriving[0], leaving[-1] = leaving[0], arriving[-1]
    return arriving, leaving


def _open_spline_tangents(
    nodes: FloatArray, values: FloatArray, slopes: tuple[FloatArray | None, FloatArray | None]
) -> FloatArray:
    """Return the tangents of open cubic splines, (n, k); a free end as in `open_tangents`."""
    steep = 1.0 / np.diff(nodes)
    tangents = np.empty_like(values)
    for end, inwards, slope in ((0, 1, slopes[0]), (-1, -1, slopes[1])):
        near = slice(None, None, inwards)
        weights = end_derivative_weights(nodes[None, near][:, :4])[0]
        tangents[end] = weights @ values[near][:4] if slope is None else slope
    if len(nodes) == 2:
        return tangents
    # each row divided by both its steps: the system is symmetric then, and solved in a third of the time
    rise = np.diff(values, axis=0)
    rise *= (3.0 * steep * steep)[:, None]
    right = rise[:-1] + rise[1:]
    right[0] -= steep[0] * tangents[0]
    right[-1] -= steep[-1] * tangents[-1]
    bands = np.stack([2.0 * (steep[:-1] + steep[1:]), steep[1:]])
    if len(right) == 1:  # SciPy has no room for one row's missing neighbour
        tangents[1:-1] = right / bands[0]
        return tangents
    tangents[1:-1] = solveh_banded(
        bands, right, lower=True, overwrite_ab=True, overwrite_b=True, check_finite=False
    )
    return tangents
