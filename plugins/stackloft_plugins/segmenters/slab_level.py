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

from stackloft.geometry.noise_floor import EMPTY, MEAN, MEDIAN, NoiseFloor, noise_floor
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.ahead import worked_ahead
from stackloft_plugins.segmenters.grey import Grey, grey_levels
from stackloft_plugins.segmenters.histogram_levels import histogram_level

Levels = NDArray[Any]
"""(rows, columns) grey levels of any real dtype."""
SAMPLED = 24
"""Slices looked at."""
_NEAR, _FAR = 3.0, 10.0  # pixels
_ROUNDS = 3
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
    """Return the grey levels of every fourth pixel of a sample of slices, (n)."""
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
    return np.concatenate([grey[::2, ::2].ravel().astype(np.float32) for grey in sample])


def _half_way(sample: list[Levels], level: float, *, above: bool, where: str) -> SlabLevel:
    sign = 1.0 if above else -1.0
    for _ in range(_ROUNDS):
        inside, outside = _bands(sample, level, sign)
        if not inside.size or not outside.size:
            raise InputError("no boundary between a body and its background", where=where,
                             fix="give --set segmenter.threshold=LEVEL")  # fmt: skip
        body, air = float(np.median(inside)), float(np.median(outside))
        floor = noise_floor(outside) if above else 0.0
        level = 0.5 * (body + air - floor * MEDIAN / MEAN)
    noise = 1.4826 * float(np.median(np.abs(outside - air)))
    step = abs(body - air)
    dark = air - floor * MEDIAN / MEAN
    if not above or level - dark < 2.0 * EMPTY * floor:
        floor = 0.0
    found = SlabLevel(level, above, NoiseFloor.over(dark, floor))
    if step > _FAINT * noise:
        return found
    text = f"{where}: body and background differ by {step:.3g} grey levels, noise {noise:.2g}; look there"
    return replace(found, notices=(Notice("low-contrast", text),))


def _bands(sample: list[Levels], level: float, sign: float) -> tuple[Grey, Grey]:
    """Return the grey levels in the bands within and beyond the boundaries; nearer where bodies are thin."""
    found = list(worked_ahead(len(sample), lambda k: _slice_bands(sample[k], level, sign)))
    deep, thin, outside = (np.concatenate(bands) for bands in zip(*found, strict=True))
    return deep if deep.size else thin, outside


def _slice_bands(grey: Levels, level: float, sign: float) -> tuple[Grey, Grey, Grey]:
    """Return the levels in the band within, in all of the body but its rim, and in the band beyond."""
    if grey.dtype.kind in "iu":
        mask = (grey > math.floor(level) if sign > 0.0 else grey < math.ceil(level)).view(np.uint8)
    else:
        mask = (grey > level if sign > 0.0 else grey < level).view(np.uint8)
    if not mask.any() or mask.all():
        empty = np.zeros(0, dtype=np.float32)
        return empty, empty, empty
    window = _window(mask)
    grey, mask = grey[window], np.ascontiguousarray(mask[window])
    within, beyond = _distance(mask), _distance(1 - mask)
    bands = (within > _NEAR) & (within <= _FAR), within > 1, (beyond > _NEAR) & (beyond <= _FAR)
    inside, thin, outside = (grey[band].astype(np.float32) for band in bands)
    return inside, thin, outside


def _window(mask: cv2.typing.MatLike) -> tuple[slice, slice]:
    """Return the rows and columns of the body and all within `_FAR` pixels of it."""
    left, top, width, height = cv2.boundingRect(mask)
    room = math.ceil(_FAR) + 2
    rows, columns = mask.shape
    return (
        slice(max(0, top - room), min(rows, top + height + room)),
        slice(max(0, left - room), min(columns, left + width + room)),
    )


def _distance(mask: cv2.typing.MatLike) -> Grey:
    return np.asarray(cv2.distanceTransform(mask, cv2.DIST_L2, 3), dtype=np.float32)


def frame_of(grey: Levels) -> Grey:
    """Return the outermost pixels, taken for background."""
    return np.concatenate([grey[0], grey[-1], grey[:, 0], grey[:, -1]]).astype(np.float32)
