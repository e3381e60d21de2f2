"""Chains of rings of unknowns, each coupled to its neighbours in the ring and to one in the next ring."""

from __future__ import annotations

from ctypes import c_int, c_int64, c_void_p

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import address
from stackloft.compiled.kernel import Kernel

FloatArray = NDArray[np.float64]

LONGEST = 128
"""Unknowns of a ring; beyond, what is at work leaves the processor's nearest cache and LAPACK is faster."""
_solve = Kernel("stackloft_solve_rings", c_int, c_int64, c_int64, c_void_p, c_void_p, c_void_p, c_void_p)


def solve_rings(
    diagonal: FloatArray, along: FloatArray, across: FloatArray, right: FloatArray
) -> FloatArray | None:
    """Return the solution of a symmetric positive definite system, (m, n).

    None without compiled kernels, for rings of fewer than three or more than `LONGEST`, and where the
    matrix is not positive definite.

    Parameters
    ----------
    diagonal : (m, n) array
        Each unknown's own coefficient: m rings of n.
    along : (m, n) array
        With the next round the ring.
    across : (m, n) array
        With the same of the next ring; nothing in the last.
    right : (m, n) array
        Right side.

    Examples
    --------
    >>> one = np.ones((2, 3))
    >>> found = solve_rings(4.0 * one, one, np.array([[1.0], [0.0]]) * one, 7.0 * one)
    >>> found is None or found.round(12).tolist()
    [[1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]
    """
    solve, (rings, around) = _solve.here(), diagonal.shape
    if solve is None or not 3 <= around <= LONGEST:
        return None
    own = [np.ascontiguousarray(each, np.float64) for each in (diagonal, along, across)]
    solved = np.array(right, np.float64, order="C")
    return solved if solve(rings, around, *map(address, own), address(solved)) else None
