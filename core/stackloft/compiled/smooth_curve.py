"""Closed loops looked through for corners and smoothed."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import POINTER, byref, c_double, c_int, c_int32, c_int64, c_void_p
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import Scratch, address
from stackloft.compiled.kernel import THREADS, Kernel

FloatArray = NDArray[np.float64]


class _SmoothJob(ctypes.Structure):
    _fields_ = (
        ("points", c_void_p),
        ("length", c_int64),
        ("out", c_void_p),
        ("capacity", c_int64),
        ("count", c_int64),
    )


class _SmoothJobs(ctypes.Structure):
    _fields_ = (
        ("spacing", c_double),
        ("step", c_double),
        ("fewest", c_double),
        ("loops", POINTER(_SmoothJob)),
    )


class _TurnJob(ctypes.Structure):
    _fields_ = (("points", c_void_p), ("length", c_int64), ("pixel", c_double), ("answer", c_int32))


class _TurnJobs(ctypes.Structure):
    _fields_ = (
        ("shortest", c_double),
        ("wide", c_double),
        ("least_cosine", c_double),
        ("near", c_int32),
        ("far", c_int32),
        ("loops", POINTER(_TurnJob)),
    )


_smooth = Kernel("stackloft_smooth_closed", None, POINTER(_SmoothJobs), c_int64, c_int)
_turn = Kernel("stackloft_may_turn", None, POINTER(_TurnJobs), c_int64, c_int)
_samples = Scratch(np.float64, 2)


@dataclass(frozen=True, slots=True)
class Turns:
    """When a loop may have a corner."""

    shortest: float
    """Pixels around; a shorter loop may have any."""
    wide: float
    """Pixels between samples."""
    near: int
    """First sample behind and ahead of each that a line is fitted to."""
    far: int
    """Last one."""
    least_cosine: float
    """Of the angle between the two lines where there is no corner."""


def smooth_closed(
    loops: Sequence[FloatArray], spacing: float, step: float, fewest: int
) -> list[FloatArray | None]:
    """Return closed loops as least-squares cubic splines on even knots, sampled evenly.

    None of a loop whose vertices are too few for even knots; None of all without compiled kernels.

    Parameters
    ----------
    loops : sequence of (k, 2) arrays
        Vertices, none of which repeats the one before.
    spacing, step : float
        Between knots and between samples.
    fewest : int
        Spans that there are at least.
    """
    smooth = _smooth.here()
    if smooth is None or not loops:
        return [None] * len(loops)
    own = [np.ascontiguousarray(points, np.float64) for points in loops]
    rooms = [max(16, 2 * len(points)) for points in own]
    room, starts = _samples.rows(sum(rooms)), np.cumsum([0, *rooms]).tolist()
    place, size = address(room), room.strides[0]
    jobs = (_SmoothJob * len(own))(
        *(
            _SmoothJob(address(points), len(points), place + start * size, most)
            for points, start, most in zip(own, starts[:-1], rooms, strict=True)
        )
    )
    smooth(byref(_SmoothJobs(spacing, step, float(fewest), jobs)), len(own), THREADS)
    return [
        room[start : start + job.count].copy() if job.count else None
        for start, job in zip(starts[:-1], jobs, strict=True)
    ]


def turns_somewhere(loops: Sequence[FloatArray], pixels: Sequence[float], rules: Turns) -> list[bool] | None:
    """Return for each traced loop whether it may have a corner; None without compiled kernels.

    Parameters
    ----------
    loops : sequence of (k, 2) arrays
        Vertices, mm.
    pixels : sequence of float
        Pixel size of each, mm.
    rules : Turns
    """
    turn = _turn.here()
    if turn is None:
        return None
    own = [np.ascontiguousarray(points, np.float64) for points in loops]
    jobs = (_TurnJob * len(own))(
        *(_TurnJob(address(points), len(points), pixel) for points, pixel in zip(own, pixels, strict=True))
    )
    given = _TurnJobs(rules.shortest, rules.wide, rules.least_cosine, rules.near, rules.far, jobs)
    turn(byref(given), len(own), THREADS)
    return None if any(job.answer < 0 for job in jobs) else [bool(job.answer) for job in jobs]
