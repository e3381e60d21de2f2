r"""A table or holder taken out of a scan: what is the same on all slices.

::

    grey of one pixel, slice by slice          what is left when almost all of the slices at a pixel are
                 ______                        at least as bright: air under the body, table under the
      body   ___/      \___    on air          table. That much is subtracted, so that a pixel filled in
      table  =====/''\=====    + body          part by the table keeps the body's own part.

It needs slices on which the holder is alone, beyond the body's ends; a body that runs through the whole scan
would be taken for its holder, and is refused by its thickness.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np

from stackloft.model.arrays import read_only
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft_plugins.segmenters.grey import Grey, grey_levels
from stackloft_plugins.segmenters.slab_level import SlabLevel, frame_of

_SHARE = 0.05
"""Part of the slices that may be darker than the holder at a pixel of it."""
_AROUND = 2
"""Pixels beyond the holder in which its blurred edge is taken out too."""
_MOST_BYTES = 1 << 28
_SAMPLED = 64
_FEWEST = 8


def without_holder(stack: SliceStack, channel: str, found: SlabLevel, thickest: float) -> SliceStack:
    """Return the stack with what is the same on all slices brought down to air.

    Parameters
    ----------
    stack : SliceStack
        Of slabs.
    channel : str
        What grey is made of.
    found : SlabLevel
        The level that tells body and holder from air.
    thickest : float
        mm: what is thicker is no holder.

    Raises
    ------
    InputError
        What is the same everywhere is too thick, or there are too few slices to tell.
    """
    sign = 1.0 if found.body_above else -1.0
    count = min(len(stack), _SAMPLED, max(_FEWEST, _MOST_BYTES // (4 * stack.shape[0] * stack.shape[1])))
    if count < _FEWEST:
        raise InputError(
            "too few slices to tell a holder from what lies on it",
            where="--set segmenter.holder=remove",
            found=f"{len(stack)}",
            expected=f"at least {_FEWEST}",
        )
    numbers = np.unique(np.linspace(0, len(stack) - 1, count).astype(int))
    sample = np.stack([sign * grey_levels(stack.decode(int(k)), channel) for k in numbers])
    air = float(np.median(np.concatenate([frame_of(grey) for grey in sample])))
    same = np.quantile(sample, _SHARE, axis=0).astype(np.float32)
    holder = (same > sign * found.level).astype(np.uint8)
    if not holder.any():
        return replace(
            stack, notices=(*stack.notices, Notice("no-holder", "nothing is the same on all slices"))
        )
    _check_thickness(holder, stack, thickest)
    near = cv2.dilate(holder, np.ones((2 * _AROUND + 1, 2 * _AROUND + 1), np.uint8))
    excess = read_only(np.where(near > 0, sign * np.maximum(same - air, 0.0), 0.0).astype(np.float32))
    row, column = stack.pixel_spacing.mean(axis=0)
    area = float(np.count_nonzero(holder) * row * column)
    text = f"a holder of {area:.4g} mm² on every slice was taken out; look at its place in the overview"
    return replace(
        stack,
        decode=_Freed(stack.decode, excess, channel),
        notices=(*stack.notices, Notice("holder-removed", text)),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Freed:
    """A decoder that takes the holder out of what another gives."""

    decode: Callable[[int], Picture]
    excess: Grey
    channel: str

    def __call__(self, number: int) -> Picture:
        return read_only(grey_levels(self.decode(number), self.channel) - self.excess)


def _check_thickness(holder: cv2.typing.MatLike, stack: SliceStack, thickest: float) -> None:
    """Refuse a holder into which a disc of more than `thickest` mm fits."""
    framed = np.pad(np.asarray(holder, np.uint8), 1)
    widest = (
        2.0 * float(cv2.distanceTransform(framed, cv2.DIST_L2, 5).max()) * float(stack.pixel_spacing.min())
    )
    if widest > thickest:
        raise InputError(
            "what is the same on all slices is too thick for a holder; it may be the body itself",
            where="--set segmenter.holder=remove",
            found=f"{widest:.3g} mm",
            expected=f"at most {thickest:g} mm",
            fix="scan beyond the body's ends, or raise --set segmenter.holder_thickness",
        )
