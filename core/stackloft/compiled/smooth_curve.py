"""Closed loops looked through for corners and smoothed, one at a time."""

from __future__ import annotations

from ctypes import c_double, c_int, c_int64, c_void_p

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Scratch, address
from stackloft.compiled.kernel import Kernel

FloatArray = NDArray[np.float64]

_smooth = Kernel(
    "stackloft_smooth_closed", c_int64, c_void_p, c_int64, c_double, c_double, c_double, c_void_p, c_int64
)
_turn = Kernel(
    "stackloft_may_turn", c_int, c_void_p, c_int64, c_double, c_double, c_double, c_int, c_int, c_double
)
_samples = Scratch(np.float64, 2)


def smooth_closed(points: FloatArray, spacing: float, step: float, fewest: int) -> FloatArray | None:
    """Return a closed loop's least-squares cubic spline on even knots, sampled evenly.

    None without compiled kernels, or where vertices are too few for even knots.

    Parameters
    ----------
    points : (k, 2) array
        Vertices, none of which repeats the one before.
    spacing, step : float
        Between knots and between samples.
    fewest : int
        Spans that there are at least.
    """
    smooth = _smooth.here()
    if smooth is None:
        return None
    own = np.ascontiguousarray(points, np.float64)
    capacity = max(16, 2 * len(own))
    room = _samples.rows(capacity)
    count = smooth(address(own), len(own), spacing, step, float(fewest), address(room), capacity)
    return room[:count].copy() if count else None


def turns_somewhere(
    points: FloatArray,
    pixel: float,
    shortest: float,
    wide: float,
    lines: tuple[int, int],
    least_cosine: float,
) -> bool | None:
    """Return whether a traced loop may have a corner; None without compiled kernels.

    Parameters
    ----------
    points : (k, 2) array
        Vertices, mm.
    pixel : float
        Pixel size, mm.
    shortest : float
        Pixels around; a shorter loop may have any.
    wide : float
        Pixels between samples.
    lines : tuple of int
        First and last sample behind and ahead of each that a line is fitted to.
    least_cosine : float
        Of the angle between the two lines where there is no corner.
    """
    turn = _turn.here()
    if turn is None:
        return None
    own = np.ascontiguousarray(points, np.float64)
    answer = turn(address(own), len(own), pixel, shortest, wide, *lines, least_cosine)
    return None if answer < 0 else bool(answer)
