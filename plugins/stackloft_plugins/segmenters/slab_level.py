r"""One grey level for a whole scan: half-way between what lies beside the boundary on either side.

::

    grey     body ######\                      inside band:  3 to 10 px within
                         \  <- level           outside band: 3 to 10 px beyond
             air          \........            of all boundaries of a sample of slices

A slab blurs slanting boundaries over several pixels, differently on every slice; with one level for all
slices, half-way between the two plateaus, a voxel that is half full lies on the boundary (ISO 50 %, VDI/VDE
2630-1.2). The bands keep away from the blur and take the median, so that what it reaches does not matter.
Where noise lifts the background (`geometry.noise_floor`), the level is half-way between no signal and body.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.bands import bands
from stackloft.geometry.median import median
from stackloft.geometry.noise_floor import EMPTY, MEAN, MEDIAN, NoiseFloor, noise_floor
from stackloft.model.arrays import BoolArray
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.ahead import AHEAD, SMALL, worked_ahead
from stackloft_plugins.segmenters.grey import Grey, grey_levels
from stackloft_plugins.segmenters.histogram_levels import histogram_level

Levels = NDArray[Any]
"""(rows, columns) grey levels of any real dtype."""
SAMPLED = 24
"""Slices looked at."""
_DEEP, _THIN = (3, 10), (1, None)  # pixels from the boundary
_ROUNDS = 3
_POOLED = 1 << 14
"""Pixels of a slice that its histogram needs."""
_FAINT = 4.0  # standard deviations of noise


@dataclass(frozen=True, slots=True)
class SlabLevel:
    """The boundary's level and on which side of it the body is."""

    level: float
    body_above: bool
    noise: NoiseFloor | None = None
    """What noise adds to empty pixels, where it does."""
    notices: tuple[Notice, ...] = ()


def slab_level(
    stack: SliceStack, method: str, channel: str, background: str | None, sampled: int = SAMPLED
) -> SlabLevel:
    """Return the level for all slices.

    Parameters
    ----------
    stack : SliceStack
    method : str
        ``half-way``, or a method of `histogram_levels` on the sample's pooled histogram.
    channel : str
        What grey is made of.
    background : str or None
        ``light`` or ``dark``; None: found from the frame of the pictures.
    sampled : int
        How many slices are looked at, evenly from the first to the last.

    Raises
    ------
    InputError
        The scan is blank, or shows no boundary.
    """
    sample = _sample(stack, channel, sampled)
    where = f"{stack.names[0]} … {stack.names[-1]}"
    pooled = _pooled(sample)
    first = histogram_level(pooled, "otsu" if method == "half-way" else method, where)
    frames = np.concatenate([frame_of(grey) for grey in sample])
    above = background == "dark" or (background is None and float(np.mean(frames < first)) > 0.5)
    if method != "half-way":
        return SlabLevel(first, above)
    return _half_way(sample, first, above=above, where=where)


def pooled_sample(stack: SliceStack, channel: str, sampled: int) -> Grey:
    """Return the grey levels of every fourth pixel of a sample of slices, of large ones fewer, (n)."""
    return _pooled(_sample(stack, channel, sampled))


def _sample(stack: SliceStack, channel: str, sampled: int) -> list[Levels]:
    numbers = np.unique(np.linspace(0, len(stack) - 1, sampled).astype(int))
    return [_levels(stack.decode(int(k)), channel) for k in numbers]


def _levels(picture: Picture, channel: str) -> Levels:
    """Return grey levels; a scan's own short whole numbers need no copy, and take no more memory."""
    if picture.ndim == 2 and picture.dtype.kind in "iu" and picture.dtype.itemsize <= 2:
        return picture
    return grey_levels(picture, channel)


def _pooled(sample: list[Levels]) -> Grey:
    step = max(2, math.isqrt(sample[0].size // _POOLED))
    return np.concatenate([grey[::step, ::step].ravel() for grey in sample]).astype(np.float32)


def _half_way(sample: list[Levels], level: float, *, above: bool, where: str) -> SlabLevel:
    sign = 1.0 if above else -1.0
    whole = all(grey.dtype.kind in "iu" for grey in sample)
    for _ in range(_ROUNDS):
        last = level
        inside, outside = _bands(sample, level, sign)
        if not inside.size or not outside.size:
            raise InputError("no boundary between a body and its background", where=where,
                             fix="give --set segmenter.threshold=LEVEL")  # fmt: skip
        body, air = median(inside), median(outside)
        floor = noise_floor(outside) if above else 0.0
        level = 0.5 * (body + air - floor * MEDIAN / MEAN)
        if level == last or (whole and _same_side(level, last)):
            break  # the bands would be the same again
    noise = 1.4826 * median(np.abs(outside - np.float32(air)))
    step = abs(body - air)
    dark = air - floor * MEDIAN / MEAN
    if not above or level - dark < 2.0 * EMPTY * floor:
        floor = 0.0
    found = SlabLevel(level, above, NoiseFloor.over(dark, floor))
    if step > _FAINT * noise:
        return found
    text = f"{where}: body and background differ by {step:.3g} grey levels, noise {noise:.2g}; look there"
    return replace(found, notices=(Notice("low-contrast", text),))


def _same_side(level: float, other: float) -> bool:
    """Return whether two levels part whole numbers alike."""
    return math.floor(level) == math.floor(other) and math.ceil(level) == math.ceil(other)


def _bands(sample: list[Levels], level: float, sign: float) -> tuple[Levels, Levels]:
    """Return the grey levels in the bands within and beyond the boundaries; nearer where bodies are thin."""
    inside, outside = _gathered(sample, level, sign, _DEEP)
    return (inside if inside.size else _gathered(sample, level, sign, _THIN)[0]), outside


def _gathered(
    sample: list[Levels], level: float, sign: float, within: tuple[int, int | None]
) -> tuple[Levels, Levels]:
    ahead = AHEAD if sample[0].size >= SMALL else 0
    found = list(worked_ahead(len(sample), lambda k: _slice_bands(sample[k], level, sign, within), ahead))
    inside, outside = (np.concatenate(bands) for bands in zip(*found, strict=True))
    return inside, outside


def _slice_bands(
    grey: Levels, level: float, sign: float, within: tuple[int, int | None]
) -> tuple[Levels, Levels]:
    """Return the levels in the band within, and in the band beyond."""
    if grey.dtype.kind in "iu":
        mask = (grey > math.floor(level) if sign > 0.0 else grey < math.ceil(level)).view(np.uint8)
    else:
        mask = (grey > level if sign > 0.0 else grey < level).view(np.uint8)
    if not mask.any() or mask.all():
        return grey[:0, 0], grey[:0, 0]
    window = _window(mask)
    grey = grey[window]
    quick = bands(grey, level, _DEEP) if sign > 0.0 and within == _DEEP else None
    if quick is not None:
        return quick
    mask = np.ascontiguousarray(mask[window])
    inside, outside = _band(mask, within), _band(1 - mask, _DEEP)
    return grey[inside], grey[outside]


def _band(mask: cv2.typing.MatLike, within: tuple[int, int | None]) -> BoolArray:
    """Return the pixels of a mask further from its boundary than the one distance, no further than the other.

    Distances are those of chessboards, never more than true ones: squares take a tenth of the time of discs.
    """
    near, far = within
    band = _eroded(mask, near)
    return (band if far is None else band ^ _eroded(mask, far)).view(np.bool_)


def _eroded(mask: cv2.typing.MatLike, reach: int) -> NDArray[np.uint8]:
    square = np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)
    return np.asarray(cv2.erode(mask, square, borderType=cv2.BORDER_CONSTANT, borderValue=1), np.uint8)


def _window(mask: cv2.typing.MatLike) -> tuple[slice, slice]:
    """Return the rows and columns of the body and all as far beyond it as the band reaches."""
    left, top, width, height = cv2.boundingRect(mask)
    room = _DEEP[1] + 2
    rows, columns = mask.shape
    return (
        slice(max(0, top - room), min(rows, top + height + room)),
        slice(max(0, left - room), min(columns, left + width + room)),
    )


def frame_of(grey: Levels) -> Grey:
    """Return the outermost pixels, taken for background."""
    return np.concatenate([grey[0], grey[-1], grey[:, 0], grey[:, -1]]).astype(np.float32)
