r"""The grey levels of body and background, from rings on either side of the zone of partly filled pixels.

::

    background ring | edge zone | body ring | deep inside        the nearest pixels that are surely full
         mean       |           |  median   |                    or empty: what lies further off may differ
"""

from __future__ import annotations

import numpy as np

from stackloft.compiled.coverage import Rings
from stackloft.geometry.median import median
from stackloft.model.arrays import FloatArray
from stackloft.model.segmentation import SectionField
from stackloft_plugins.integrators.morphology import Mask, dilated, eroded

_RING = 4
"""px: width of the rings beside the edge zone from which the two grey levels are taken."""
ENOUGH = 20
"""Pixels in a ring for its level to count."""
_LARGE = 40_000
"""Pixels of a crop from which on a quarter of the rings tells their levels as well."""
_OUTLIER = 6.0
"""Robust standard deviations: what is further from the background's median does not count in its mean."""


def rings_of(section: SectionField) -> Rings:
    """Return the rings that are looked at: of a large slice every other pixel of every other row."""
    step = 2 if section.values.size > _LARGE else 1
    return Rings(_RING // step, step)


def ring_values(
    section: SectionField, inside: Mask, near: Mask, rings: Rings
) -> tuple[FloatArray, FloatArray]:
    """Return the field in the ring within the edge zone, and in the one beyond it.

    Parameters
    ----------
    section : SectionField
    inside, near : arrays of uint8, (rows, columns) of its crop
        1 within the edge zone; 1 within it and in it.
    rings : Rings
    """
    step = rings.step
    seen = section.every(step) if step > 1 else section
    inside, near = (np.ascontiguousarray(mask[::step, ::step]) for mask in (inside, near))
    ring = np.ones((2 * rings.reach + 1,) * 2, np.uint8)
    within = (inside ^ eroded(inside, ring)).view(np.bool_)
    beyond = (near ^ dilated(near, ring)).view(np.bool_)
    return seen.relative_where(within), seen.relative_where(beyond)


def ring_levels(within: FloatArray, beyond: FloatArray) -> tuple[float, float]:
    """Return the body's median and the background's mean, above the section's level; NaN of too few pixels.

    Examples
    --------
    >>> ring_levels(np.full(30, 40.0), np.full(10, -60.0))
    (40.0, nan)
    """
    return level_of(within), _mean_level(beyond)


def level_of(values: FloatArray, enough: int = ENOUGH) -> float:
    """Return the median of values; NaN of fewer than `enough`."""
    return median(values) if len(values) >= enough else float("nan")


def _mean_level(values: FloatArray) -> float:
    """Return the mean without outliers: it is a sum that it is taken off from, and noise may be skewed."""
    if len(values) < ENOUGH:
        return float("nan")
    off = np.abs(values - median(values))
    return float(values[off <= _OUTLIER * 1.4826 * median(off)].mean())
