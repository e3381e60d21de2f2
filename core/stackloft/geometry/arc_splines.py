r"""Cubic splines through many arcs at once: closed loops and pieces between corners.

All arcs of a stack are laid end to end and their tangents found by one banded solve, which is what
makes fitting a whole stack a matter of milliseconds.

::

    closed loop                      loop with corners c0, c1: two open arcs
       .--.                             c0 ----.
     (      )   wraps on itself           \\      \\
       `--'                                `---- c1
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

WRAP = 28
"""Nodes repeated on both sides of a closed arc: a cubic spline forgets as 0.268^n, so 28 leave 1e-16."""


def spline_tangents(nodes: FloatArray, points: FloatArray, starts: IntArray) -> FloatArray:
    """Return dP/dt at the nodes of several open cubic splines.

    Parameters
    ----------
    nodes : (n,) array
        Parameter values, increasing inside each arc.
    points : (n, d) array
        Points to interpolate.
    starts : (a,) int array
        First index of each arc; an arc has at least 2 nodes.

    Returns
    -------
    (n, d) array
        Tangents of the C² cubic spline of each arc, whose end tangents are those of the polynomial
        through its first (last) four points, so that the order of accuracy is 4 up to the ends
        (de Boor 1978, A Practical Guide to Splines, ch. IV).

    Examples
    --------
    >>> t = np.linspace(0.0, 1.0, 6)
    >>> spline_tangents(t, (t**3)[:, None], np.array([0]))[:, 0].round(12)
    array([0.  , 0.12, 0.48, 1.08, 1.92, 3.  ])
    """
    n = len(nodes)
    stops = np.append(starts[1:], n)
    planes = np.ascontiguousarray(points.T)  # rows of two take several times as long as two rows
    step = np.diff(nodes)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.diff(planes, axis=1) / step
    bands = np.zeros((3, n))
    rhs = np.empty_like(planes)
    before, after = step[:-1], step[1:]
    bands[0, 2:] = before
    bands[1, 1:-1] = 2.0 * (before + after)
    bands[2, :-2] = after
    rhs[:, 1:-1] = 3.0 * (after * slope[:, :-1] + before * slope[:, 1:])
    for ends, towards_inside in ((starts, 1), (stops - 1, -1)):
        bands[1, ends] = 1.0
        bands[2, ends[ends > 0] - 1] = 0.0
        bands[0, ends[ends + 1 < n] + 1] = 0.0
        rhs[:, ends] = _end_tangents(nodes, points, starts, stops, towards_inside).T
    return np.asarray(
        solve_banded((1, 1), bands, rhs.T, overwrite_ab=True, overwrite_b=True, check_finite=False)
    )


def _end_tangents(
    nodes: FloatArray, points: FloatArray, starts: IntArray, stops: IntArray, step: int
) -> FloatArray:
    """Return the derivative at each arc's end of the polynomial through its nearest ≤ 4 points."""
    counts = np.minimum(stops - starts, 4)
    ends = starts if step > 0 else stops - 1
    tangents = np.empty((len(starts), points.shape[1]))
    for count in np.unique(counts):
        chosen = np.flatnonzero(counts == count)
        index = ends[chosen, None] + step * np.arange(count)
        weights = end_derivative_weights(nodes[index])
        tangents[chosen] = np.einsum("ak,akd->ad", weights, points[index])
    return tangents


def end_derivative_weights(t: FloatArray) -> FloatArray:
    """Return weights w with Σ w_k f(t_k) = f′(t_0) for polynomials through the k nodes.

    Parameters
    ----------
    t : (a, k) array
        Nodes of `a` independent stencils, k ≥ 2; the derivative is taken at the first node.

    Returns
    -------
    (a, k) array

    Examples
    --------
    >>> end_derivative_weights(np.array([[0.0, 1.0, 2.0]]))
    array([[-1.5,  2. , -0.5]])
    """
    a, k = t.shape
    weights = np.zeros((a, k))
    for j in range(1, k):
        others = [i for i in range(1, k) if i != j]
        numerator = np.prod(t[:, [0]] - t[:, others], axis=1) if others else np.ones(a)
        denominator = np.prod(t[:, [j]] - t[:, [0, *others]], axis=1)
        weights[:, j] = numerator / denominator
    weights[:, 0] = -weights[:, 1:].sum(axis=1)
    return weights
