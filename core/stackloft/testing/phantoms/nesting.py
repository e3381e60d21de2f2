"""Which loops are holes, and which way round each one runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import Loop


def contains(polygon: FloatArray, point: FloatArray) -> bool:
    """Tell whether `point` (2) lies in the polygon (k, 2), by crossings of a ray (even–odd rule).

    Examples
    --------
    >>> square = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])
    >>> contains(square, np.array([1.0, 1])), contains(square, np.array([3.0, 1]))
    (True, False)
    """
    x, y = (polygon - point).T
    xn, yn = np.roll(x, -1), np.roll(y, -1)
    crosses = (y > 0) != (yn > 0)
    rise = np.where(crosses, yn - y, 1.0)
    return bool(np.count_nonzero(crosses & (x - y * (xn - x) / rise > 0)) % 2)


def turned(loop: Loop, positive: bool, hole: bool) -> Loop:
    """Return `loop` counter-clockwise (`positive`) or clockwise, keeping its first point and corners."""
    if (loop.signed_area > 0) == positive:
        return Loop(loop.points, loop.corners, hole)
    k = len(loop.points)
    order = -np.arange(k) % k
    return Loop(frozen_floats(loop.points[order]), frozen_ints(np.sort(-loop.corners % k)), hole)


def oriented(loops: Sequence[Loop]) -> tuple[Loop, ...]:
    """Return outer loops counter-clockwise and holes clockwise, largest first.

    Examples
    --------
    >>> square = np.array([[0.0, 0], [0, 4], [4, 4], [4, 0]])
    >>> [(loop.hole, loop.signed_area) for loop in oriented([Loop(square / 4 + 1), Loop(square)])]
    [(False, 16.0), (True, -1.0)]
    """
    ordered = sorted(loops, key=lambda loop: -abs(loop.signed_area))
    result = []
    for i, loop in enumerate(ordered):
        depth = sum(contains(other.points, loop.points[0]) for other in ordered[:i])
        result.append(turned(loop, positive=depth % 2 == 0, hole=depth % 2 == 1))
    return tuple(result)
