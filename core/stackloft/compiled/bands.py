"""Grey levels in bands within and beyond a body's boundary."""

from __future__ import annotations

from ctypes import POINTER, byref, c_double, c_int, c_int64, c_void_p
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Pixels, Scratch, address, pixels_of
from stackloft.compiled.kernel import Kernel

_ROOM = 1 << 16
"""Pixels of a band; a larger one is left to others."""
_gather = Kernel(
    "stackloft_bands", c_int, POINTER(Pixels), c_double, c_int, c_int, c_void_p, c_int64, c_void_p
)
_values = Scratch(np.float64, _ROOM)


def bands(
    values: NDArray[Any], level: float, within: tuple[int, int]
) -> tuple[NDArray[Any], NDArray[Any]] | None:
    """Return the grey levels of the pixels in two bands, above and not above a level; None without kernels.

    Parameters
    ----------
    values : (rows, columns) array
    level : float
    within : tuple of int
        Pixels in these bands lie further from the boundary than the one distance, no further than the other;
        distances are those of chessboards, and beyond the picture lies more of what is at its border.

    Examples
    --------
    >>> grey = np.zeros((9, 9), np.int16)
    >>> grey[:, 4:] = np.arange(4, 9)
    >>> found = bands(grey, 3.0, (1, 3))
    >>> found is None or (np.unique(found[0]).tolist(), found[1].size)
    ([5, 6], 18)
    """
    gather, picture = _gather.here(), pixels_of(values)
    if gather is None or picture is None:
        return None
    room, counts = _values.rows(2), np.zeros(2, np.int64)
    if not gather(byref(picture), level, *within, address(room), _ROOM, address(counts)):
        return None
    inside, outside = (room[k, : counts[k]].astype(values.dtype) for k in (0, 1))
    return inside, outside
