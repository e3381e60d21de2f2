r"""Slices whose body is known to a fraction of a pixel: slanting ellipses, edges as a camera sees them.

::

    +-----------------+
    |     __          |    body grey 60 on background 200, or the other way round;
    |    /  \_        |    each slice another place and size, none symmetric in rows and columns
    |    \___/        |
    +-----------------+
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack

SHAPE = (96, 132)
SLICES = 4
BACKGROUND, BODY = 200.0, 60.0
_AXES = (31.0, 17.0)
_SLANT = 0.6


def body_of(k: int) -> tuple[float, FloatArray]:
    """Return area in pixels and centre (row, column) of slice `k`'s body."""
    a, b = _axes(k)
    return float(np.pi * a * b), _centre(k)


def picture_of(k: int, body: float = BODY, background: float = BACKGROUND) -> FloatArray:
    """Return slice `k`, not rounded; the edge is one pixel wide."""
    a, b = _axes(k)
    row, column = np.mgrid[: SHAPE[0], : SHAPE[1]] - _centre(k)[:, None, None]
    along = np.cos(_SLANT) * column + np.sin(_SLANT) * row
    across = np.cos(_SLANT) * row - np.sin(_SLANT) * column
    level = np.hypot(along / a, across / b)
    slope = np.hypot(along / a**2, across / b**2) / np.maximum(level, 1e-9)
    inside = np.clip(0.5 - (level - 1.0) / np.maximum(slope, 1e-9), 0.0, 1.0)
    noise = np.random.default_rng(k).normal(0.0, 1.5, SHAPE)
    return np.asarray(background + (body - background) * inside + noise)


def stack_of(change: Callable[[FloatArray], Picture] | None = None, decoded: list[int] | None = None) -> Any:
    """Return the stack.

    Parameters
    ----------
    change : callable, optional
        What becomes of each picture; None: rounded to 8 bits.
    decoded : list of int, optional
        Takes the number of each slice that is decoded.
    """
    make = change or as_bytes

    def decode(k: int) -> Picture:
        if decoded is not None:
            decoded.append(k)
        return make(picture_of(k))

    names = tuple(f"slice_{k + 1}.png" for k in range(SLICES))
    spacing = frozen_floats(np.tile((0.3, 0.3), (SLICES, 1)))
    shape = make(picture_of(0)).shape[:2]
    return SliceStack(decode, names, shape, frozen_floats(5.0 * np.arange(SLICES)), spacing, SectionKind.FACE)


def as_bytes(picture: FloatArray) -> Picture:
    """Return a picture rounded to 8 bits."""
    return picture.round().clip(0, 255).astype(np.uint8)


def _axes(k: int) -> tuple[float, float]:
    return _AXES[0] - 2.0 * k, _AXES[1] - 1.3 * k


def _centre(k: int) -> FloatArray:
    return np.array([44.3 + 1.7 * k, 71.6 - 3.1 * k])
