"""A slice's body where it is one piece without a hole, from the picture alone."""

from __future__ import annotations

from ctypes import POINTER, byref, c_double, c_int, c_int64, c_void_p
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Pixels, Scratch, address, pixels_of
from stackloft.compiled.kernel import Kernel

_LONGEST = 1 << 15
"""Border pixels that the kernel follows; a longer outline is left to others."""
_follow = Kernel(
    "stackloft_solid_piece", c_int, POINTER(Pixels), c_double, c_void_p, c_int64, c_void_p, c_void_p, c_int,
    c_int, c_void_p, c_int,
)  # fmt: skip
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


def solid_piece(values: NDArray[Any], level: float, cracks: Cracks) -> SolidPiece | None:
    """Return the body of a picture where it is so simple; None of others, or without compiled kernels.

    Parameters
    ----------
    values : (rows, columns) array
    level : float
        Body where values > level.
    cracks : Cracks

    Examples
    --------
    >>> grey = np.zeros((30, 40), np.int16)
    >>> grey[12:15, 14:19] = 7
    >>> found = solid_piece(grey, 3.5, Cracks(np.array([2, 2, 0], np.int32), 20, 5))
    >>> found is None or (found.outline[0].tolist(), found.shape, found.pixels, found.open)
    ([14, 12], (3, 5), 15, True)
    """
    follow, picture = _follow.here(), pixels_of(values)
    if follow is None or picture is None:
        return None
    chain, box, numbers = _chains.rows(_LONGEST), np.empty(4, np.int32), np.empty(3, np.int64)
    answer = follow(
        byref(picture), level, address(chain), _LONGEST, address(box), address(numbers), cracks.frame,
        len(cracks.reach) - 1, address(cracks.reach), cracks.fewest,
    )  # fmt: skip
    if answer != 1:
        return None
    top, left, rows, columns = box.tolist()
    length, pixels, is_open = numbers.tolist()
    return SolidPiece(chain[:length].copy(), (top, left), (rows, columns), pixels, bool(is_open))
