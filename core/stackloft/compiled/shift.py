"""Stored 16-bit values brought to a scanner's own grey scale in one pass over them."""

from __future__ import annotations

from ctypes import c_int, c_int64, c_void_p
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import address
from stackloft.compiled.kernel import Kernel

_shift = Kernel("stackloft_shift", None, c_void_p, c_int64, c_int, c_int, c_void_p)


def shifted_in_place(stored: NDArray[Any], shift: int) -> tuple[int, int] | None:
    """Add a number to 16-bit values, modulo 2¹⁶; return the least and the greatest as they were.

    None without compiled kernels, or of an array that they cannot change where it lies: then nothing is
    changed.

    Parameters
    ----------
    stored : array of int16 or uint16
        Signed or not, it holds the sums as int16 or uint16 afterwards.
    shift : int

    Examples
    --------
    >>> stored = np.array([0, 4095], dtype=np.uint16)
    >>> ends = shifted_in_place(stored, -1024)
    >>> ends is None or (ends, stored.view(np.int16).tolist())
    ((0, 4095), [-1024, 3071])
    """
    function = _shift.here()
    usable = stored.dtype.char in "hH" and stored.dtype.isnative and stored.flags.c_contiguous
    if function is None or not usable or not stored.size or not stored.flags.writeable:
        return None
    ends = np.empty(2, np.int32)
    function(address(stored), stored.size, int(stored.dtype.kind == "i"), shift & 0xFFFF, address(ends))
    low, high = ends.tolist()
    return low, high
