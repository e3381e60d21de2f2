"""Masks of a slice's crop grown and shrunk (Serra 1982)."""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.uint8]


def eroded(mask: Mask, by: Mask) -> Mask:
    """Return the mask eroded; beyond the crop lies more of it."""
    return np.asarray(cv2.erode(mask, by, borderType=cv2.BORDER_CONSTANT, borderValue=1), np.uint8)


def dilated(mask: Mask, by: Mask) -> Mask:
    """Return the mask dilated."""
    return np.asarray(cv2.dilate(mask, by), np.uint8)


@lru_cache
def disc(radius: int) -> Mask:
    """Return a disc, (2 radius + 1, 2 radius + 1)."""
    side = 2 * radius + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side)), np.uint8)
