"""What a slice adds to a body's volume by partly filled pixels."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, byref, c_double, c_int, c_void_p
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Noise, Pixels, Scratch, address, pixels_of
from stackloft.compiled.kernel import Kernel


class _Beside(ctypes.Structure):
    _fields_ = (
        ("words", c_void_p),
        ("rows", ctypes.c_int32),
        ("columns", ctypes.c_int32),
        ("down", ctypes.c_int64),
        ("right", ctypes.c_int64),
    )


class _Rings(ctypes.Structure):
    _fields_ = (
        ("values", c_void_p),
        ("counts", c_void_p),
        ("room", ctypes.c_int64),
        ("reach", ctypes.c_int32),
        ("step", ctypes.c_int32),
    )


_cover = Kernel(
    "stackloft_coverage", c_int, POINTER(Pixels), c_double, c_void_p, POINTER(_Beside), POINTER(_Beside),
    c_int, c_void_p, c_void_p, POINTER(_Rings),
)  # fmt: skip
_mask = Kernel("stackloft_mask", c_int, POINTER(Pixels), c_double, c_void_p)
_ROOM = 1 << 16
"""Pixels of a ring; the levels of a larger one are left to others."""
_ring_values = Scratch(np.float64, _ROOM)


FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """A slice's grey levels on a window of it, body where they lie above the level."""

    values: NDArray[Any]
    level: float
    offset: tuple[int, int]
    """(row, column) of the first pixel in the slice."""
    words: NDArray[np.uint64]
    """The body's mask, a bit a pixel."""

    @staticmethod
    def of(values: NDArray[Any], level: float, offset: tuple[int, int]) -> Shown | None:
        """Return a slice with its mask; None of one that the kernels cannot read, or without them."""
        masked, picture = _mask.here(), pixels_of(values)
        if masked is None or picture is None:
            return None
        rows, columns = values.shape
        words = np.empty(rows * -(-columns // 64), np.uint64)
        return Shown(values, level, offset, words) if masked(byref(picture), level, address(words)) else None


@dataclass(frozen=True, slots=True, eq=False)
class Covered:
    """Counts and sums over the zone about a slice's edge."""

    inside: int
    """px within the zone"""
    edge: int
    """px in the zone"""
    grey: float
    """Their field above the level, summed."""
    full: int
    """px of the zone that are body on all three slices"""
    full_grey: float
    """Their field, summed."""
    rings: tuple[FloatArray, FloatArray] | None
    """Where they were asked for: the field above the level beside the zone, on the body's side and beyond."""


@dataclass(frozen=True, slots=True)
class Rings:
    """Rings beside the edge zone."""

    reach: int
    """Pixels by which they are wide, counted among those seen."""
    step: int
    """Of rows and columns, every how manyeth is seen."""


def covered(
    own: Shown,
    noise: Noise | None,
    beside: tuple[Shown | None, Shown | None],
    reach: NDArray[np.int32],
    rings: Rings | None,
) -> Covered | None:
    """Return a slice's sums, given the slices before and after; None without compiled kernels.

    Parameters
    ----------
    own : Shown
    noise : Noise or None
        What noise adds to its empty pixels.
    beside : tuple
        The slices before and after; None where there is none.
    reach : (r + 1,) int32 array
        How far the rows of the disc by which the zone is wide reach, from the middle one outwards.
    rings : Rings or None
        What is wanted of the rings beside the zone.
    """
    cover, picture = _cover.here(), pixels_of(own.values, noise)
    if cover is None or picture is None:
        return None
    first, last = (byref(_placed(own, other)) for other in beside)
    sums, values, counts = np.empty(5), _ring_values.rows(2), np.zeros(2, np.int64)
    wanted = None
    if rings is not None:
        wanted = byref(_Rings(address(values), address(counts), _ROOM, rings.reach, rings.step))
    answer = cover(
        byref(picture), own.level, address(own.words), first, last, len(reach) - 1, address(reach),
        address(sums), wanted,
    )  # fmt: skip
    if not answer:
        return None
    inside, edge, grey, full, full_grey = sums.tolist()
    found = None
    if rings is not None:
        within, beyond = (values[k, : counts[k]].copy() for k in (0, 1))
        found = (within, beyond)
    return Covered(int(inside), int(edge), grey, int(full), full_grey, found)


def _placed(own: Shown, other: Shown | None) -> _Beside:
    """Return a slice beside as it lies to a slice."""
    if other is None:
        return _Beside(None, 0, 0, 0, 0)
    down, right = (other.offset[k] - own.offset[k] for k in (0, 1))
    return _Beside(address(other.words), *other.values.shape, down, right)
