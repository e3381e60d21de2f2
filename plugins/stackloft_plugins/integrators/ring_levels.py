r"""The grey levels of body and background, from rings on either side of the zone of partly filled pixels.

::

    background ring | edge zone | body ring | deep inside        the nearest pixels that are surely full
         mean       |           |  median   |                    or empty: what lies further off may differ
"""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np

from stackloft.geometry.median import median
from stackloft.model.arrays import FloatArray
from stackloft.model.segmentation import SectionField
from stackloft_plugins.integrators.seen_slice import Mask

_RING = 4
"""px: width of the rings beside the edge zone from which the two grey levels are taken."""
_ENOUGH = 20
"""Pixels in a ring for its level to count."""
_FEW = 4
"""Likewise of the innermost pixels of a thin body."""
_LARGE = 40_000
"""Pixels of a crop from which on a quarter of the rings tells their levels as well."""
_OUTLIER = 6.0
"""Robust standard deviations: what is further from the background's median does not count in its mean."""


def ring_levels(section: SectionField, inside: Mask, near: Mask) -> tuple[float, float]:
    """Return the levels of the rings beside the edge zone; of large ones every fourth pixel is seen.

    Parameters
    ----------
    section : SectionField
    inside, near : arrays of uint8, (rows, columns) of its crop
        1 within the edge zone; 1 within it and in it.

    Returns
    -------
    body, background : float
        Median within and mean beyond, above the section's level; NaN of a ring of too few pixels.
    """
    step = 2 if inside.size > _LARGE else 1
    seen = section.every(step) if step > 1 else section
    inside, near = (np.ascontiguousarray(mask[::step, ::step]) for mask in (inside, near))
    ring = np.ones((2 * (_RING // step) + 1,) * 2, np.uint8)
    within = (inside ^ eroded(inside, ring)).view(np.bool_)
    beyond = (near ^ dilated(near, ring)).view(np.bool_)
    return _level(seen.relative_where(within)), _mean_level(seen.relative_where(beyond))


def innermost(section: SectionField, common: Mask) -> float:
    """Return the level of a thin body's innermost pixels."""
    return _level(section.relative_where(eroded(common, disc(1)).view(np.bool_)), _FEW)


def eroded(mask: Mask, by: Mask) -> Mask:
    """Return the mask eroded; beyond the crop lies more of it."""
    return np.asarray(cv2.erode(mask, by, borderType=cv2.BORDER_CONSTANT, borderValue=1), np.uint8)


def dilated(mask: Mask, by: Mask) -> Mask:
    """Return the mask dilated."""
    return np.asarray(cv2.dilate(mask, by), np.uint8)


def _mean_level(values: FloatArray) -> float:
    """Return the mean without outliers: it is a sum that it is taken off from, and noise may be skewed."""
    if len(values) < _ENOUGH:
        return float("nan")
    off = np.abs(values - median(values))
    return float(values[off <= _OUTLIER * 1.4826 * median(off)].mean())


def _level(values: FloatArray, enough: int = _ENOUGH) -> float:
    return median(values) if len(values) >= enough else float("nan")


@lru_cache
def disc(radius: int) -> Mask:
    """Return a disc, (2 radius + 1, 2 radius + 1)."""
    side = 2 * radius + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side)), np.uint8)
