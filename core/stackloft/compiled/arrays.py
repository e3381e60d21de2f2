"""NumPy's arrays as the compiled kernels take them."""

from __future__ import annotations

import ctypes
import threading
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

_KINDS = {"h": 0, "H": 1, "B": 2, "b": 3, "i": 4, "f": 5, "d": 6}
"""As `source/pixels.h` numbers them."""


class Pixels(ctypes.Structure):
    """A picture, as `source/pixels.h` has it; it does not keep the array alive."""

    _fields_ = (
        ("first", ctypes.c_void_p),
        ("stride", ctypes.c_int64),
        ("rows", ctypes.c_int32),
        ("columns", ctypes.c_int32),
        ("kind", ctypes.c_int32),
        ("noisy", ctypes.c_int32),
        ("empty", ctypes.c_double),
        ("lift", ctypes.c_double),
    )


class Noise(Protocol):
    """What noise adds to empty pixels: a `NoiseFloor`."""

    @property
    def empty(self) -> float:
        """Grey level below which a pixel is taken for empty."""

    @property
    def lift(self) -> float:
        """Grey levels that noise adds to such a pixel's mean."""


def pixels_of(values: NDArray[Any], noise: Noise | None = None) -> Pixels | None:
    """Return a picture for the kernels; None of one that they cannot read as it lies in memory.

    Examples
    --------
    >>> whole = np.zeros((6, 8), np.int16)
    >>> found = pixels_of(whole[1:4, 2:7])
    >>> found.rows, found.columns, found.stride
    (3, 5, 16)
    >>> pixels_of(whole[:, ::2]) is None, pixels_of(whole.astype(complex)) is None
    (True, True)
    """
    kind = values.dtype
    if kind.char not in _KINDS or not kind.isnative or values.ndim != 2 or not values.size:
        return None
    down, along = values.strides
    if along != kind.itemsize:
        return None
    rows, columns = values.shape
    found = Pixels(address(values), down, rows, columns, _KINDS[kind.char], 0, 0.0, 0.0)
    if noise is not None:
        found.noisy, found.empty, found.lift = 1, noise.empty, noise.lift
    return found


def address(array: NDArray[Any]) -> int:
    """Return where an array's first value lies."""
    place: int = array.__array_interface__["data"][0]
    return place


class Scratch(threading.local):
    """Room that a kernel writes to, one for each thread, so that it is not taken anew for every slice."""

    def __init__(self, dtype: type[np.generic], columns: int) -> None:
        self._dtype, self._columns = dtype, columns
        self._room: NDArray[Any] = np.empty((0, columns), dtype)

    def rows(self, count: int) -> NDArray[Any]:
        """Return room for at least `count` rows; what is in it is anybody's."""
        if len(self._room) < count:
            self._room = np.empty((max(count, 2 * len(self._room)), self._columns), self._dtype)
        return self._room
