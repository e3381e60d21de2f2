"""The outline of a slice's one body, from its border pixels to points on the level, in millimetres."""

from __future__ import annotations

from ctypes import POINTER, byref, c_double, c_int64, c_void_p
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Noise, Pixels, Scratch, address, pixels_of
from stackloft.compiled.kernel import Kernel

_trace = Kernel(
    "stackloft_level_line", c_int64, POINTER(Pixels), c_double, c_void_p, c_int64, c_void_p, c_void_p,
    c_void_p, c_int64, c_void_p,
)  # fmt: skip
_points = Scratch(np.float64, 2)


def level_line(
    values: NDArray[Any],
    level: float,
    noise: Noise | None,
    chain: NDArray[np.int32],
    first: tuple[int, int],
    spacing: tuple[float, float],
) -> tuple[NDArray[np.float64], float] | None:
    """Return the points of a closed line around border pixels, and its rough area; None without kernels.

    Parameters
    ----------
    values : (rows, columns) array
        Body above the level; `noise` is what noise adds to empty pixels.
    level : float
    chain : (k, 2) int32 array
        Column, row in `values` of the body's border pixels in order.
    first : tuple of int
        Row and column of `values`'s first pixel in the slice.
    spacing : tuple of float
        mm from row to row and from column to column.

    Returns
    -------
    points : (k, 2) array
        (x, y) mm in the slice, as `sub_pixel.points_of_lines` puts them.
    area : float
        Pixels².

    None also where the body comes so near the border that the field does not show what lies beside it.
    """
    trace, picture = _trace.here(), pixels_of(values, noise)
    if trace is None or picture is None:
        return None
    chain = np.ascontiguousarray(chain, np.int32)
    capacity = max(4, 3 * len(chain))
    room, area = _points.rows(capacity), np.empty(1)
    where, steps = np.array(first, np.int32), np.array(spacing)
    count = trace(
        byref(picture), level, address(chain), len(chain), address(where), address(steps), address(room),
        capacity, address(area),
    )  # fmt: skip
    return None if count <= 0 else (room[:count].copy(), float(area[0]))
