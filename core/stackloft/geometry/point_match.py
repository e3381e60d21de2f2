r"""The rigid motion that lays points on others: matched by nearness, fitted by least squares.

::

     o     o              +     +         The rotation is that of Kabsch (1976), "A solution for the best
        o        --->        +            rotation to relate two sets of vectors", Acta Cryst. A32, 922–923.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

FloatArray = NDArray[np.float64]


def rigid_motion(start: FloatArray, target: FloatArray, *, turning: bool = True) -> tuple[float, FloatArray]:
    """Return the angle, rad from x to y, and the shift that take `start` to `target`: R·p + shift.

    Parameters
    ----------
    start, target : array (k, 2)
        Two points at least when `turning`, one otherwise.
    turning : bool
        False: a shift alone.

    Examples
    --------
    >>> square = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])
    >>> angle, shift = rigid_motion(square, square @ np.array([[0.0, 1], [-1, 0]]) + [5, 1])
    >>> round(angle / np.pi, 9), shift.round(9).tolist()
    (0.5, [5.0, 1.0])
    """
    middle, goal = start.mean(axis=0), target.mean(axis=0)
    angle = 0.0
    if turning:
        a, b = start - middle, target - goal
        sine = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
        angle = float(np.arctan2(sine, float((a * b).sum())))
    c, s = np.cos(angle), np.sin(angle)
    shift: FloatArray = goal - np.array([[c, -s], [s, c]]) @ middle
    return angle, shift


def matched(points: FloatArray, pattern: FloatArray, reach: float) -> FloatArray:
    """Return `points` in the order of `pattern`, NaN where none lies within `reach` of its place, (k, 2).

    Points and pattern differ by a small rigid motion; points that belong to nothing are left out.

    Examples
    --------
    >>> pattern = np.array([[0.0, 0], [10, 0], [0, 7]])
    >>> matched(np.array([[10.5, 1.0], [50, 50], [0.5, 1.0]]), pattern, 3.0).tolist()
    [[0.5, 1.0], [10.5, 1.0], [nan, nan]]
    """
    best, fewest = np.full_like(pattern, np.nan), -np.inf
    for start in points:
        for goal in pattern:
            found, score = _paired(points, pattern + start - goal, reach)
            if score > fewest:
                best, fewest = found, score
    return best


def _paired(points: FloatArray, pattern: FloatArray, reach: float) -> tuple[FloatArray, float]:
    """Return the points nearest to the pattern as it lies, and how good that is: many, and near."""
    apart = np.linalg.norm(points[:, None] - pattern[None], axis=2)
    rows, columns = linear_sum_assignment(np.minimum(apart, reach))
    near = apart[rows, columns] < reach
    found = np.full_like(pattern, np.nan)
    found[columns[near]] = points[rows[near]]
    return found, float(near.sum() - (apart[rows, columns][near] / reach).mean()) if near.any() else -np.inf
