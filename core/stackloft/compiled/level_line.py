"""The outlines of slices' bodies, from their border pixels to points on the level, in millimetres."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import POINTER, c_double, c_int, c_int32, c_int64, c_void_p
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Noise, Pixels, Scratch, address, pixels_of
from stackloft.compiled.kernel import THREADS, Kernel


class _Job(ctypes.Structure):
    _fields_ = (
        ("picture", Pixels),
        ("level", c_double),
        ("chain", c_void_p),
        ("length", c_int64),
        ("first", c_int32 * 2),
        ("spacing", c_double * 2),
        ("points", c_void_p),
        ("capacity", c_int64),
        ("count", c_int64),
        ("area", c_double),
    )


_trace = Kernel("stackloft_level_lines", None, POINTER(_Job), c_int64, c_int)
_points = Scratch(np.float64, 2)


@dataclass(frozen=True, slots=True, eq=False)
class Border:
    """A body's border pixels on a picture."""

    values: NDArray[Any]
    """(rows, columns), body above the level"""
    level: float
    noise: Noise | None
    """What noise adds to empty pixels."""
    chain: NDArray[np.int32]
    """(k, 2) column, row in `values`, in order round the body"""
    first: tuple[int, int]
    """Row and column of `values`'s first pixel in the slice."""
    spacing: tuple[float, float]
    """mm from row to row and from column to column"""


Line = tuple[NDArray[np.float64], float]
"""Points (x, y), (k, 2) mm in the slice, as `sub_pixel.points_of_lines` puts them; rough area, pixels²."""


def level_lines(borders: Sequence[Border]) -> list[Line | None]:
    """Return the closed lines around bodies on which their fields equal the level.

    None of a body that comes so near the picture's border that the field does not show what lies beside it;
    None of all without compiled kernels.
    """
    trace = _trace.here()
    seen = [pixels_of(one.values, one.noise) for one in borders]
    if trace is None or None in seen or not borders:
        return [None] * len(borders)
    chains = [np.ascontiguousarray(one.chain, np.int32) for one in borders]
    rooms = [max(4, 3 * len(chain)) for chain in chains]
    room = _points.rows(sum(rooms))
    starts = np.cumsum([0, *rooms]).tolist()
    place, step = address(room), room.strides[0]
    jobs = (_Job * len(borders))(
        *(
            _Job(
                picture,
                one.level,
                address(chain),
                len(chain),
                one.first,
                one.spacing,
                place + start * step,
                most,
            )
            for picture, one, chain, start, most in zip(
                seen, borders, chains, starts[:-1], rooms, strict=True
            )
        )
    )
    trace(jobs, len(jobs), THREADS)
    return [
        (room[start : start + job.count].copy(), job.area) if job.count > 0 else None
        for start, job in zip(starts[:-1], jobs, strict=True)
    ]
