"""What slices add to a body's volume by partly filled pixels."""

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

FloatArray = NDArray[np.float64]


class _MaskJob(ctypes.Structure):
    _fields_ = (("picture", Pixels), ("level", c_double), ("words", c_void_p), ("done", c_int32))


class _Beside(ctypes.Structure):
    _fields_ = (
        ("words", c_void_p),
        ("rows", c_int32),
        ("columns", c_int32),
        ("down", c_int64),
        ("right", c_int64),
    )


class _Rings(ctypes.Structure):
    _fields_ = (
        ("values", c_void_p),
        ("room", c_int64),
        ("counts", c_int64 * 2),
        ("reach", c_int32),
        ("step", c_int32),
    )


class _Job(ctypes.Structure):
    _fields_ = (
        ("picture", Pixels),
        ("level", c_double),
        ("words", c_void_p),
        ("others", _Beside * 2),
        ("half", c_void_p),
        ("radius", c_int32),
        ("done", c_int32),
        ("sums", c_double * 5),
        ("ring", _Rings),
    )


_masks = Kernel("stackloft_masks", None, POINTER(_MaskJob), c_int64, c_int)
_cover = Kernel("stackloft_coverage", None, POINTER(_Job), c_int64, c_int)
_ROOM = 1 << 16
"""Pixels of a ring; the levels of a larger one are left to others."""
_ring_values = Scratch(np.float64, _ROOM)


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """A slice's grey levels on a window of it, body where they lie above the level."""

    values: NDArray[Any]
    level: float
    offset: tuple[int, int]
    """(row, column) of the first pixel in the slice."""
    noise: Noise | None
    """What noise adds to empty pixels."""
    words: NDArray[np.uint64]
    """The body's mask, a bit a pixel."""

    @property
    def picture(self) -> Pixels:
        """The grey levels for the kernels."""
        picture = pixels_of(self.values, self.noise)
        if picture is None:
            raise TypeError(self.values.dtype)
        return picture


@dataclass(frozen=True, slots=True)
class Rings:
    """Rings beside the edge zone."""

    reach: int
    """Pixels by which they are wide, counted among those seen."""
    step: int
    """Of rows and columns, every how manyeth is seen."""


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


@dataclass(frozen=True, slots=True, eq=False)
class ToCover:
    """A slice whose edge zone is to be summed up."""

    own: Shown
    beside: tuple[Shown | None, Shown | None]
    """The slices before and after; None where there is none."""
    rings: Rings | None
    """What is wanted of the rings beside the zone."""


Field = tuple[NDArray[Any], float, tuple[int, int], "Noise | None"]
"""Grey levels, their level, the first pixel's place, noise."""


def shown_all(fields: Sequence[Field]) -> list[Shown] | None:
    """Return slices with their masks; None where the kernels cannot read all of them, or without them."""
    masks = _masks.here()
    seen = [pixels_of(values) for values, *_ in fields]
    if masks is None or None in seen or not fields:
        return None
    words = [np.empty(rows * -(-columns // 64), np.uint64) for rows, columns in (f[0].shape for f in fields)]
    jobs = (_MaskJob * len(fields))(
        *(
            _MaskJob(picture, level, address(own))
            for picture, own, (_, level, *_) in zip(seen, words, fields, strict=True)
        )
    )
    masks(jobs, len(jobs), THREADS)
    if not all(job.done for job in jobs):
        return None
    return [Shown(*one, own) for one, own in zip(fields, words, strict=True)]


def covered_all(slices: Sequence[ToCover], reach: NDArray[np.int32]) -> list[Covered | None]:
    """Return slices' sums; None of one whose rings are too large, of all without compiled kernels.

    Parameters
    ----------
    slices : sequence of ToCover
    reach : (r + 1,) int32 array
        How far the rows of the disc by which the zone is wide reach, from the middle one outwards.
    """
    cover = _cover.here()
    if cover is None or not slices:
        return [None] * len(slices)
    room = _ring_values.rows(2 * len(slices))
    jobs = (_Job * len(slices))(*(_job(one, room[2 * k], reach) for k, one in enumerate(slices)))
    cover(jobs, len(jobs), THREADS)
    return [
        _covered(job, room[2 * k : 2 * k + 2], one.rings)
        for k, (job, one) in enumerate(zip(jobs, slices, strict=True))
    ]


def _job(one: ToCover, room: FloatArray, reach: NDArray[np.int32]) -> _Job:
    own, first, last = one.own, *(_placed(one.own, other) for other in one.beside)
    ring = _Rings(None, 0, (0, 0), 0, 1)
    if one.rings is not None:
        ring = _Rings(address(room), _ROOM, (0, 0), one.rings.reach, one.rings.step)
    half, radius = address(reach), len(reach) - 1
    return _Job(own.picture, own.level, address(own.words), (first, last), half, radius, 0, (), ring)


def _covered(job: _Job, room: FloatArray, rings: Rings | None) -> Covered | None:
    if not job.done:
        return None
    inside, edge, grey, full, full_grey = job.sums
    found = None
    if rings is not None:
        within, beyond = (room[k, : job.ring.counts[k]].copy() for k in (0, 1))
        found = (within, beyond)
    return Covered(int(inside), int(edge), grey, int(full), full_grey, found)


def _placed(own: Shown, other: Shown | None) -> _Beside:
    """Return a slice beside as it lies to a slice."""
    if other is None:
        return _Beside(None, 0, 0, 0, 0)
    down, right = (other.offset[k] - own.offset[k] for k in (0, 1))
    return _Beside(address(other.words), *other.values.shape, down, right)
