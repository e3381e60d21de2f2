"""A coarse look at a slice: is the background light or dark, and whereabouts is the body.

::

    +--------------------+     frame: the outermost pixels, taken for background
    |    +--------+      |
    |    |  body  |      |     window: the body's bounding box and a margin;
    |    +--------+      |     everything costly is done inside it alone
    +--------------------+
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft_plugins.segmenters.grey import Grey

MARGIN = 12
"""Pixels kept around the body, for the bands beside its boundary."""

_COARSE_SIDE = 1000  # pixels on the longer side of the coarse look
_FRAME = 0.02  # width of the frame, as a fraction of the shorter side
_DEBRIS = 0.005  # objects below this fraction of the largest do not widen the window
_UNSURE = 0.35  # fraction of the frame on the other side of the threshold

Mask = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Background:
    """What the frame of a picture says."""

    dark: bool
    sure: bool
    """False when much of the frame lies on either side of the threshold: the body covers part of it."""


def coarse_step(shape: tuple[int, ...]) -> int:
    """Return the stride of the coarse look.

    Examples
    --------
    >>> coarse_step((3000, 4000, 3)), coarse_step((300, 500))
    (4, 1)
    """
    return max(1, round(max(shape[:2]) / _COARSE_SIDE))


def background_of(grey: Grey, level: float) -> Background:
    """Return whether the frame of the picture is darker than `level`.

    Examples
    --------
    >>> plate = np.full((50, 50), 240, dtype=np.float32)
    >>> plate[20:30, 20:30] = 90
    >>> background_of(plate, 165.0)
    Background(dark=False, sure=True)
    """
    width = max(1, round(_FRAME * min(grey.shape)))
    frame = np.concatenate(
        [grey[:width].ravel(), grey[-width:].ravel(), grey[:, :width].ravel(), grey[:, -width:].ravel()]
    )
    dark = float(np.mean(frame < level))
    return Background(dark > 0.5, not _UNSURE < dark < 1 - _UNSURE)


def body_window(mask: Mask, step: int, shape: tuple[int, int]) -> tuple[slice, slice] | None:
    """Return the rows and columns that hold the body; None when `mask` is empty.

    Parameters
    ----------
    mask : ndarray of uint8, (rows / step, columns / step)
        1 where the coarse look sees the body.
    step : int
        Stride of the coarse look.
    shape : tuple of int
        (rows, columns) of the whole slice.
    """
    outlines, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    if not outlines:
        return None
    boxes = np.array([cv2.boundingRect(outline) for outline in outlines])
    sizes = np.array([cv2.contourArea(outline) for outline in outlines])
    left, top, width, height = boxes[sizes >= _DEBRIS * sizes.max()].T
    bottom, right = (top + height).max(), (left + width).max()
    margin = MARGIN + step
    rows = slice(max(0, int(top.min()) * step - margin), min(shape[0], int(bottom) * step + margin))
    columns = slice(max(0, int(left.min()) * step - margin), min(shape[1], int(right) * step + margin))
    return rows, columns


def main_body(mask: Mask) -> Mask:
    """Leave in `mask` only the object with the largest outline, its holes filled, and return it."""
    outlines, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    mask.fill(0)
    if outlines:
        largest = max(outlines, key=cv2.contourArea)
        cv2.drawContours(mask, [largest], -1, 1, thickness=cv2.FILLED)
    return mask
