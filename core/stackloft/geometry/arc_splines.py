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
from scipy.linalg import solveh_banded

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
    >>> spline_tangents(t, (t**3)[:, None], np.array([0]))[:, 0].round(12) + 0.0
    array([0.  , 0.12, 0.48, 1.08, 1.92, 3.  ])
    """
    stops = np.append(starts[1:], len(nodes))
    planes = np.ascontiguousarray(points.T)  # rows of two take several times as long as two rows
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # between arcs
        steep = 1.0 / np.diff(nodes)
        rise = np.diff(planes)
        rise *= 3.0 * steep * steep
    # each row divided by both its steps, so that the system is symmetric; what is known at the ends put in
    bands, right = np.empty((2, len(nodes))), np.empty_like(planes)
    np.add(steep[:-1], steep[1:], out=bands[0, 1:-1])
    bands[0] *= 2.0
    bands[1, :-1] = steep
    np.add(rise[:, :-1], rise[:, 1:], out=right[:, 1:-1])
    known = [_end_tangents(nodes, points, starts, stops, inwards).T for inwards in (1, -1)]
    for ends, inside, gap, tangents in ((starts, 1, 0, known[0]), (stops - 1, -1, -1, known[1])):
        right[:, ends + inside] -= steep[ends + gap] * tangents
        bands[1, ends + gap] = 0.0
    for ends, tangents in zip((starts, stops - 1), known, strict=True):
        bands[0, ends], right[:, ends] = 1.0, tangents
    bands[1, stops - 1] = 0.0
    return np.asarray(
        solveh_banded(bands, right.T, lower=True, overwrite_ab=True, overwrite_b=True, check_finite=False)
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
    k = t.shape[1]
    weights = np.zeros(t.shape)
    for j in range(1, k):
        weights[:, j] = 1.0 / (t[:, j] - t[:, 0])
        for i in range(1, k):
            if i != j:
                weights[:, j] *= (t[:, 0] - t[:, i]) / (t[:, j] - t[:, i])
    weights[:, 0] = -weights[:, 1:].sum(axis=1)
    return weights
