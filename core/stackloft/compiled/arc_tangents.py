"""Tangents of the cubic splines that closed loops consist of, arc after arc."""

from __future__ import annotations

from ctypes import c_int, c_int64, c_void_p

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import address
from stackloft.compiled.kernel import Kernel

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_tangents = Kernel("stackloft_arc_tangents", c_int, c_int64, c_void_p, c_void_p, c_void_p * 2, c_void_p * 4)


def arc_tangents(planes: FloatArray, first: IntArray, arcs: IntArray) -> tuple[FloatArray, FloatArray] | None:
    """Return dP/dx at the starts and at the ends of all loops' segments, (2, n) each; None without kernels.

    Parameters
    ----------
    planes : (2, n) array
        x and y of the vertices, loop after loop, mm; segment i leaves vertex i.
    first : (m + 1,) int array
        First vertex of each loop.
    arcs : (a, 4) int array
        Of each arc its loop, first vertex, nodes, and nodes at either end that only lead in or out.

    Examples
    --------
    >>> square = np.array([[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]])
    >>> sides = np.array([[0, k, 2, 0] for k in range(4)])
    >>> found = arc_tangents(square, np.array([0, 4]), sides)
    >>> found is None or found[0].tolist()
    [[1.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, -1.0]]
    """
    tangents = _tangents.here()
    if tangents is None:
        return None
    own, begins = np.ascontiguousarray(arcs, np.int64), np.ascontiguousarray(first, np.int64)
    x, y = (np.ascontiguousarray(row, np.float64) for row in planes)
    slopes = np.empty((4, len(x)))
    done = tangents(
        len(own),
        address(own),
        address(begins),
        (c_void_p * 2)(address(x), address(y)),
        (c_void_p * 4)(*map(address, slopes)),
    )
    return (slopes[:2], slopes[2:]) if done else None
