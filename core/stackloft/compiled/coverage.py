"""What a slice adds to a body's volume by partly filled pixels."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, byref, c_double, c_int, c_void_p
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Noise, Pixels, address, pixels_of
from stackloft.compiled.kernel import Kernel


class _Beside(ctypes.Structure):
    _fields_ = (
        ("picture", POINTER(Pixels)),
        ("level", c_double),
        ("down", ctypes.c_int64),
        ("right", ctypes.c_int64),
    )


_cover = Kernel(
    "stackloft_coverage", c_int, POINTER(Pixels), c_double, POINTER(_Beside), POINTER(_Beside), c_int,
    c_void_p, c_void_p, c_void_p,
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """A slice's grey levels on a window of it, body where they lie above the level."""

    values: NDArray[Any]
    level: float
    offset: tuple[int, int]
    """(row, column) of the first pixel in the slice."""


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
    masks: NDArray[np.uint8] | None
    """(3, rows, columns), if they were asked for: 1 within the zone; within it and in it; on all slices."""


def covered(
    own: Shown,
    noise: Noise | None,
    beside: tuple[Shown | None, Shown | None],
    reach: NDArray[np.int32],
    *,
    masks: bool,
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
    masks : bool
        Whether the masks are wanted.
    """
    cover, picture = _cover.here(), pixels_of(own.values, noise)
    if cover is None or picture is None:
        return None
    others = [_placed(own, other) for other in beside]
    if None in others:
        return None
    sums = np.empty(5)
    shown = np.empty((3, *own.values.shape), np.uint8) if masks else None
    where = None if shown is None else address(shown)
    first, last = (byref(other) for other in others if other is not None)
    if not cover(
        byref(picture), own.level, first, last, len(reach) - 1, address(reach), address(sums), where
    ):
        return None
    inside, edge, grey, full, full_grey = sums.tolist()
    return Covered(int(inside), int(edge), grey, int(full), full_grey, shown)


def _placed(own: Shown, other: Shown | None) -> _Beside | None:
    """Return a slice beside as it lies to a slice; None of one that the kernels cannot read."""
    if other is None:
        return _Beside(None, 0.0, 0, 0)
    picture = pixels_of(other.values)
    if picture is None:
        return None
    down, right = (other.offset[k] - own.offset[k] for k in (0, 1))
    return _Beside(ctypes.pointer(picture), other.level, down, right)
