r"""A level that follows the light and the plate around the body: shadow, juice, reflections.

::

     plate            in shadow         Half-way between the body's edge and what lies beside it, here and not
    ‾‾‾‾\             ____              on the mean of the whole outline: juice or a shadow beside one
         \--- level   ‾‾‾\--- level     side of the body moves the level there, and the boundary nowhere.
          \___            \___

Where the surroundings are even there is nothing to follow, and the one level stays.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stackloft.model.arrays import IntArray
from stackloft_plugins.segmenters.body_window import main_body
from stackloft_plugins.segmenters.cell_means import CellMeans, cell_means
from stackloft_plugins.segmenters.grey import Grey
from stackloft_plugins.segmenters.half_way import Edge, inside_band, outside_band
from stackloft_plugins.segmenters.stretch_levels import UNEVEN, stretch_levels

_SPAN = 0.2
"""Of the contrast: what the outer band must span for a closer look."""
REACH = 8.0
"""Pixels: standard deviation of the window in which the two sides are averaged."""
_OUTLIER = 4.0  # robust standard deviations: a reflection or a crumb in a band
_FEWEST = 40  # usual pixels of a band
_TRUST = 1e-3
_FURTHEST = 0.3  # of the contrast: no local level is further from the one level


def on_one_level(grey: Grey, edge: Edge, level: float) -> tuple[Grey, Edge]:
    """Return grey levels whose boundary is at `level` wherever it is, and the edge in them.

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
    >>> even, _ = on_one_level(scene, edge, edge.level)
    >>> [round(float(scene[60, column] - even[60, column] + edge.level)) for column in (40, 79)]
    [70, 85]
    """
    local = local_levels(grey, edge, level)
    if local is None:
        return grey, edge
    local -= np.float32(level)
    even = np.subtract(grey, local, out=local)
    return even, replace(edge, mask=main_body((even > level).view(np.uint8)))


def local_levels(grey: Grey, edge: Edge, level: float) -> Grey | None:
    """Return the level pixel by pixel, (rows, columns); None where one level serves."""
    if edge.span < _SPAN * edge.contrast:
        return None
    along = stretch_levels(grey, edge, level)
    if along is not None:
        return along
    bands = inside_band(edge.mask), outside_band(edge.mask)
    within, beyond = (_side(grey, band) for band in bands)
    if within is None or beyond is None:
        return None
    beside = 0.5 * np.concatenate([within.at(band) + beyond.at(band) for band in bands])
    if float(beside.std()) < UNEVEN * edge.contrast:
        return None
    half = np.float32(0.5) * (within.cells + beyond.cells) - np.float32(np.median(beside))
    moved = CellMeans(half, within.shape).everywhere()
    furthest = _FURTHEST * edge.contrast
    return np.clip(moved, -furthest, furthest, out=moved) + np.float32(level)


def _side(grey: Grey, band: IntArray) -> CellMeans | None:
    """Return the mean of a band's usual pixels about each place; None when hardly any is there."""
    values = grey.ravel()[band]
    if not len(values):
        return None
    off = np.abs(values - np.median(values))
    usual = off <= _OUTLIER * max(1.4826 * float(np.median(off)), 1.0)
    if np.count_nonzero(usual) < _FEWEST:
        return None
    shape: tuple[int, int] = grey.shape
    return cell_means(shape, band[usual], values[usual], REACH, _TRUST)
