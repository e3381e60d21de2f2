"""Read-only arrays: what the frozen types hold."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


def frozen_floats(values: ArrayLike) -> FloatArray:
    """Return a read-only float64 copy of `values`."""
    array: FloatArray = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def frozen_ints(values: ArrayLike) -> IntArray:
    """Return a read-only int64 copy of `values`."""
    array: IntArray = np.array(values, dtype=np.int64)
    array.setflags(write=False)
    return array


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """Return a read-only view of `array` (no copy)."""
    view = array.view()
    view.setflags(write=False)
    return view


def native(values: NDArray[Any]) -> NDArray[Any]:
    """Return `values` in this machine's byte order, which OpenCV needs; itself when it is in it.

    Examples
    --------
    >>> native(np.array([258], dtype=">u2")).dtype.isnative
    True
    """
    return values if values.dtype.isnative else values.astype(values.dtype.newbyteorder("="))
