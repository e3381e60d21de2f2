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

from dataclasses import dataclass

import cv2
import numpy as np

from stackloft.geometry.noise_floor import MEAN, MEDIAN, noise_floor
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import SliceStack
from stackloft_plugins.segmenters.grey import Grey, grey_levels
from stackloft_plugins.segmenters.histogram_levels import histogram_level

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
    noise_floor: float = 0.0
    """Grey levels by which noise lifts the background above no signal."""
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


def _sample(stack: SliceStack, channel: str, sampled: int) -> list[Grey]:
    numbers = np.unique(np.linspace(0, len(stack) - 1, sampled).astype(int))
    return [grey_levels(stack.decode(int(k)), channel) for k in numbers]


def _pooled(sample: list[Grey]) -> Grey:
    return np.concatenate([grey[::2, ::2].ravel() for grey in sample])


def _half_way(sample: list[Grey], level: float, *, above: bool, where: str) -> SlabLevel:
    sign = 1.0 if above else -1.0
    for _ in range(_ROUNDS):
        inside, outside = _bands(sample, level, sign)
        if not inside.size or not outside.size:
            raise InputError("no boundary between a body and its background", where=where,
                             fix="give --set segmenter.threshold=LEVEL")  # fmt: skip
        body, air = float(np.median(inside)), float(np.median(outside))
        floor = noise_floor(sign * outside)
        level = 0.5 * (body + air - sign * floor * MEDIAN / MEAN)
    noise = 1.4826 * float(np.median(np.abs(outside - air)))
    step = abs(body - air)
    if step > _FAINT * noise:
        return SlabLevel(level, above, floor)
    text = f"{where}: body and background differ by {step:.3g} grey levels, noise {noise:.2g}; look there"
    return SlabLevel(level, above, floor, (Notice("low-contrast", text),))


def _bands(sample: list[Grey], level: float, sign: float) -> tuple[Grey, Grey]:
    """Return the grey levels in the bands within and beyond the boundaries; nearer where bodies are thin."""
    inside, outside, thin = [], [], []
    for grey in sample:
        mask = (sign * grey > sign * level).astype(np.uint8)
        if not mask.any() or mask.all():
            continue
        within, beyond = _distance(mask), _distance(1 - mask)
        inside.append(grey[(within > _NEAR) & (within <= _FAR)])
        thin.append(grey[within > 1])
        outside.append(grey[(beyond > _NEAR) & (beyond <= _FAR)])
    empty = np.zeros(0, dtype=np.float32)
    deep = np.concatenate([empty, *inside])
    return deep if deep.size else np.concatenate([empty, *thin]), np.concatenate([empty, *outside])


def _distance(mask: cv2.typing.MatLike) -> Grey:
    return np.asarray(cv2.distanceTransform(mask, cv2.DIST_L2, 3), dtype=np.float32)


def frame_of(grey: Grey) -> Grey:
    """Return the outermost pixels, taken for background."""
    return np.concatenate([grey[0], grey[-1], grey[:, 0], grey[:, -1]])
