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
from stackloft_plugins.segmenters.across_edge import Across, across
from stackloft_plugins.segmenters.body_outline import main_outline
from stackloft_plugins.segmenters.cell_means import CellMeans, cell_means
from stackloft_plugins.segmenters.grey import Grey, Levels
from stackloft_plugins.segmenters.half_way import Edge
from stackloft_plugins.segmenters.stretch_levels import UNEVEN, stretch_levels

_SPAN = 0.2
"""Of the contrast: what the outer band must span for a closer look."""
REACH = 8.0
"""Pixels: standard deviation of the window in which the two sides are averaged."""
_SQUARE = 16
"""Pixels."""
_OUTLIER = 4.0  # robust standard deviations: a reflection or a crumb in a band
_FEWEST = 40  # usual pixels of a band
_TRUST = 1e-3
_FURTHEST = 0.3  # of the contrast: no local level is further from the one level


def on_one_level(
    grey: Levels, edge: Edge, level: float, seen: Across | None = None, unit: float = 1.0
) -> tuple[Levels, Edge]:
    """Return grey levels whose boundary is at `level` wherever it is, and the edge in them.

    Parameters
    ----------
    grey : ndarray, (rows, columns)
        Body above background.
    edge : Edge
        What the bands beside the boundary say.
    level : float
        The one level, as good as it can be.
    seen : Across, optional
        What is seen across the boundary at that level, where somebody has looked.
    unit : float
        Grey levels of the picture that one of `grey` is.

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
    local = local_levels(grey, edge, level, seen, unit)
    if local is None:
        return grey, edge
    even = replace(local, cells=local.cells - np.float32(level)).taken_off(grey)
    return even, replace(edge, outline=main_outline(even, level))


def local_levels(
    grey: Levels, edge: Edge, level: float, seen: Across | None = None, unit: float = 1.0
) -> CellMeans | None:
    """Return the level all over the picture; None where one level serves."""
    if edge.span < _SPAN * edge.contrast:
        return None
    if seen is None:
        seen = across(grey, main_outline(grey, level), level)
    along = stretch_levels(grey, edge.contrast, level, seen)
    if along is not None:
        return along
    bands = edge.outline.inner, edge.outline.outer
    sides = [_usual(grey, band, unit) for band in bands]
    if min(len(where) for where, _ in sides) < _FEWEST or _is_even(sides, grey.shape, UNEVEN * edge.contrast):
        return None
    within, beyond = (cell_means(edge.outline.shape, *side, REACH, _TRUST) for side in sides)
    beside = 0.5 * np.concatenate([within.at(band) + beyond.at(band) for band in bands])
    if float(beside.std()) < UNEVEN * edge.contrast:
        return None
    moved = np.float32(0.5) * (within.cells + beyond.cells) - np.float32(np.median(beside))
    furthest = _FURTHEST * edge.contrast
    return replace(within, cells=np.clip(moved, -furthest, furthest) + np.float32(level))


def _usual(grey: Levels, band: IntArray, unit: float) -> tuple[IntArray, Grey]:
    """Return a band's usual pixels, by their number, and their levels."""
    values = grey.ravel()[band].astype(np.float32)
    off = np.abs(values - np.median(values)) if len(values) else values
    spread = float(np.median(off)) if len(values) else 0.0
    usual = off <= _OUTLIER * max(1.4826 * spread, 1.0 / unit)
    return band[usual], values[usual]


def _is_even(sides: list[tuple[IntArray, Grey]], shape: tuple[int, ...], least: float) -> bool:
    """Return whether means in squares, smaller than the window, scatter no more than `least` along the bands.

    The window's means then scatter less: they need not be worked out.
    """
    squares = -(-shape[1] // _SQUARE)
    total, places = np.zeros(0), []
    for where, values in sides:
        row, column = np.divmod(where, shape[1])
        at = row // _SQUARE * squares + column // _SQUARE
        count = squares * -(-shape[0] // _SQUARE)
        usual = float(values.mean(dtype=np.float64))
        number, sums = (np.bincount(at, weights, count) for weights in (None, values))
        means = np.where(number > 0, sums / np.maximum(number, 1), usual)
        total = 0.5 * means if not len(total) else total + 0.5 * means
        places.append(at)
    return bool(total[np.concatenate(places)].std() < least)
