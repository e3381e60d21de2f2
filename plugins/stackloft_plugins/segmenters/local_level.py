r"""A level that follows the light and the plate around the body: shadow, juice, reflections.

::

     plate            in shadow         Half-way between the body's edge and what lies beside it, here and not
    ‾‾‾‾\             ____              on the mean of the whole outline: juice or a shadow beside one
         \--- level   ‾‾‾\--- level     side of the body moves the level there, and the boundary nowhere.
          \___            \___

Where the surroundings are even there is nothing to follow, and the one level stays.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft_plugins.segmenters.grey import Grey
from stackloft_plugins.segmenters.half_way import Edge, inside_band, outside_band
from stackloft_plugins.segmenters.stretch_levels import UNEVEN, stretch_levels

_SPAN = 0.2
"""Of the contrast: what the outer band must span for a closer look."""
REACH = 8.0
"""Pixels: standard deviation of the window in which the two sides are averaged."""
_OUTLIER = 4.0  # robust standard deviations: a reflection or a crumb in a band
_FURTHEST = 0.3  # of the contrast: no local level is further from the one level


def local_levels(grey: Grey, edge: Edge, level: float) -> FloatArray | None:
    """Return the level pixel by pixel, (rows, columns); None where one level serves.

    Parameters
    ----------
    grey : ndarray, (rows, columns)
        Body above background.
    edge : Edge
        What the bands beside the boundary say.
    level : float
        The one level, as good as it can be.

    Examples
    --------
    >>> from stackloft_plugins.segmenters.half_way import half_way_edge
    >>> scene = np.full((120, 120), 20, dtype=np.float32)
    >>> scene[:, 60:] = 50                                       # juice on the right
    >>> scene[40:80, 40:80] = 120
    >>> edge = half_way_edge(scene, 85.0)
    >>> found = local_levels(scene, edge, edge.level)
    >>> [round(float(found[60, column])) for column in (40, 79)]
    [70, 85]
    """
    if edge.span < _SPAN * edge.contrast:
        return None
    along = stretch_levels(grey, edge, level)
    if along is not None:
        return along
    inner, outer = inside_band(edge.mask), outside_band(edge.mask)
    within = _sides_mean(grey, inner & _usual(grey, inner))
    beyond = _sides_mean(grey, outer & _usual(grey, outer))
    if within is None or beyond is None:
        return None
    half = 0.5 * (within + beyond)
    beside = half[inner | outer]
    if float(beside.std()) < UNEVEN * edge.contrast:
        return None
    moved = half - float(np.median(beside))
    furthest = _FURTHEST * edge.contrast
    return np.asarray(level + np.clip(moved, -furthest, furthest), dtype=np.float64)


def _usual(grey: Grey, band: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return where the grey level is within the band's usual spread."""
    values = grey[band]
    middle = float(np.median(values))
    spread = max(1.4826 * float(np.median(np.abs(values - middle))), 1.0)
    return np.asarray(np.abs(grey - middle) <= _OUTLIER * spread)


def _sides_mean(grey: Grey, chosen: NDArray[np.bool_]) -> FloatArray | None:
    """Return the chosen pixels' mean in a window about each pixel; None when hardly any is chosen."""
    if chosen.sum() < 40:
        return None
    weight = chosen.astype(np.float32)
    near = cv2.GaussianBlur(weight, (0, 0), REACH)
    total = cv2.GaussianBlur(np.where(chosen, grey, 0).astype(np.float32), (0, 0), REACH)
    usual = np.float32(grey[chosen].mean())
    trust = np.float32(1e-3)
    return np.asarray((total + trust * usual) / (near + trust), dtype=np.float64)
