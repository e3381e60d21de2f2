"""Figures of closed piecewise cubics by Gauss's rule, loop after loop."""

from __future__ import annotations

from ctypes import c_int, c_int64, c_void_p

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import address
from stackloft.compiled.kernel import Kernel

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Pair = tuple[FloatArray, FloatArray]

_figures = Kernel(
    "stackloft_curve_figures",
    c_int,
    *(c_int64, c_void_p, c_void_p * 8, c_int64, c_void_p * 2, c_int64, c_void_p * 2, c_void_p, c_void_p),
)


def curve_figures(
    segments: tuple[FloatArray, FloatArray, FloatArray, FloatArray], first: IntArray, gauss: Pair, turns: Pair
) -> Pair | None:
    """Return figures of each curve, and the fraction of length at each segment's start; None without kernels.

    The figures, (7, m): length, area, the polygon's area, the centroid from the curve's first point, and
    the first Fourier coefficient about the centroid, real and imaginary.

    Parameters
    ----------
    segments : tuple of (2, n) arrays
        Starts, ends, and dP/dx at both, mm.
    first : (m + 1,) int array
        First segment of each curve; each has one at least.
    gauss : tuple of arrays
        At most four places from 0 to 1, and their weights.
    turns : tuple of arrays
        Cosines and sines of equal parts of a turn, from 0 to the whole one.

    Examples
    --------
    >>> corners = np.array([[0.0, 2.0, 2.0, 0.0], [0.0, 0.0, 2.0, 2.0]])
    >>> after = np.roll(corners, -1, axis=1)
    >>> side, turn = after - corners, 0.5 * np.pi * np.arange(5)
    >>> middle, quarters = (np.array([0.5]), np.array([1.0])), (np.cos(turn), np.sin(turn))
    >>> found = curve_figures((corners, after, side, side), np.array([0, 4]), middle, quarters)
    >>> found is None or (found[0][:5, 0].tolist(), found[1].tolist())
    ([8.0, 4.0, 4.0, 1.0, 1.0], [0.0, 0.25, 0.5, 0.75])
    """
    figures = _figures.here()
    if figures is None:
        return None
    begins = np.ascontiguousarray(first, np.int64)
    rows = [np.ascontiguousarray(row, np.float64) for each in segments for row in each]
    rule, table = ([np.ascontiguousarray(each, np.float64) for each in pair] for pair in (gauss, turns))
    count = len(begins) - 1
    found, fractions = np.empty((count, 7)), np.empty(len(rows[0]))
    done = figures(
        *(count, address(begins), (c_void_p * 8)(*map(address, rows))),
        *(len(rule[0]), (c_void_p * 2)(*map(address, rule))),
        *(len(table[0]) - 1, (c_void_p * 2)(*map(address, table))),
        *(address(fractions), address(found)),
    )
    return (found.T, fractions) if done else None
