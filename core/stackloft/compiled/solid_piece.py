"""A slice's body where it is one piece without a hole, from the picture alone."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import POINTER, c_double, c_int, c_int32, c_int64, c_void_p
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Pixels, Scratch, address, pixels_of
from stackloft.compiled.kernel import THREADS, Kernel

_LONGEST = 1 << 15
"""Border pixels that the kernel follows; a longer outline is left to others."""


class _Job(ctypes.Structure):
    _fields_ = (
        ("picture", Pixels),
        ("level", c_double),
        ("chain", c_void_p),
        ("capacity", c_int64),
        ("half", c_void_p),
        ("radius", c_int32),
        ("fewest", c_int32),
        ("frame", c_int32),
        ("answer", c_int32),
        ("box", c_int32 * 4),
        ("length", c_int64),
        ("count", c_int64),
        ("closed", c_int64),
    )


_find = Kernel("stackloft_solid_pieces", None, POINTER(_Job), c_int64, c_int)
_chains = Scratch(np.int32, 2)


@dataclass(frozen=True, slots=True, eq=False)
class SolidPiece:
    """A body of one 4-connected piece without a hole, nowhere held together by corners alone."""

    outline: NDArray[np.int32]
    """(k, 2) column, row of its border pixels in order, from the leftmost of its first row."""
    corner: tuple[int, int]
    """(row, column) of its bounding box."""
    shape: tuple[int, int]
    """Of its bounding box."""
    pixels: int
    open: bool
    """Whether it surely closes no background in; False: not known."""


@dataclass(frozen=True, slots=True, eq=False)
class Cracks:
    """When background is closed in."""

    reach: NDArray[np.int32]
    """How far the rows of a disc reach to either side, from the middle one outwards: what it does not pass
    is closed."""
    fewest: int
    """Pixels of a crack; fewer are none."""
    frame: int
    """Pixels around the body that are looked at."""


def solid_pieces(pictures: Sequence[tuple[NDArray[Any], float]], cracks: Cracks) -> list[SolidPiece | None]:
    """Return the body of each picture where it is so simple; None of others, of all without compiled kernels.

    Parameters
    ----------
    pictures : sequence of ((rows, columns) array, float)
        Grey levels and a level: body where they lie above it.
    cracks : Cracks

    Examples
    --------
    >>> grey = np.zeros((30, 40), np.int16)
    >>> grey[12:15, 14:19] = 7
    >>> (found,) = solid_pieces([(grey, 3.5)], Cracks(np.array([2, 2, 0], np.int32), 20, 5))
    >>> found is None or (found.outline[0].tolist(), found.shape, found.pixels, found.open)
    ([14, 12], (3, 5), 15, True)
    """
    find = _find.here()
    seen = [pixels_of(values) for values, _ in pictures]
    if find is None or None in seen:
        return [None] * len(pictures)
    room = _chains.rows(_LONGEST * len(pictures))
    start, reach = address(room), address(cracks.reach)
    step = _LONGEST * room.strides[0]
    jobs = (_Job * len(pictures))(
        *(
            _Job(
                picture,
                level,
                start + k * step,
                _LONGEST,
                reach,
                len(cracks.reach) - 1,
                cracks.fewest,
                cracks.frame,
            )
            for k, (picture, (_, level)) in enumerate(zip(seen, pictures, strict=True))
        )
    )
    find(jobs, len(jobs), THREADS)
    return [_found(job, room[k * _LONGEST :]) for k, job in enumerate(jobs)]


def _found(job: _Job, chain: NDArray[np.int32]) -> SolidPiece | None:
    if job.answer != 1:
        return None
    top, left, rows, columns = job.box
    outline = chain[: job.length].copy()
    return SolidPiece(outline, (top, left), (rows, columns), job.count, not job.closed)
