r"""Reflections at the body's edge on a light plate: narrow bays, lighter than the plate before them.

::

     ______            A lamp mirrored on wet flesh is as light as the plate, and where it reaches the edge
    |    .-´  plate    the outline runs around it. Such a bay is cut off from lip to lip. A crack, or the gap
    |   ( glare        behind an ear, is no lighter than the plate before its mouth, and stays.
    |    `-.
    |______|

A reflection within the body is a hole, which `sectioning.tracing` fills. On a dark plate both are on the
body's side of the level and do no harm.
"""

from __future__ import annotations

import cv2
import numpy as np

from stackloft.model.arrays import IntArray
from stackloft.model.notices import Notice
from stackloft_plugins.segmenters.body_outline import Outline
from stackloft_plugins.segmenters.body_window import Mask
from stackloft_plugins.segmenters.grey import Levels
from stackloft_plugins.segmenters.half_way import Edge

_DEEP = 2.2
"""Way around a bay by the width of its mouth: 3 for a square one."""
_WIDEST = (0.04, 14.0)
"""Of the outline's length, and pixels: a mouth wider than both is no reflection's."""
_LARGEST = 0.03
"""Of the body's area: a larger bay is none."""
_SMALLEST = 5.0
"""Square pixels, likewise."""
_LIGHTER = 0.07
"""Of the step: by so much a reflection's lightest pixels are lighter than the plate before its mouth."""
_BEFORE = 11
"""Pixels: side of the square that is looked at around a bay for the plate before it."""
_TOLD = 0.002
"""Of the body's area."""
_SOFT = 0.7
"""Pixels: standard deviation of the edge that is put across a mouth."""


def without_glare(grey: Levels, level: float, edge: Edge) -> tuple[Levels, float]:
    """Return the grey levels with the bays that reflections cut into the body filled, and their share of it.

    Parameters
    ----------
    grey : ndarray, (rows, columns)
        Body above background, on a light plate: lighter pixels are lower.
    level : float
        Of the boundary.
    edge : Edge
        What the bands beside the boundary say, and the body within it.

    Examples
    --------
    >>> from stackloft_plugins.segmenters.half_way import half_way_edge
    >>> grey = np.full((60, 60), -200, dtype=np.float32)
    >>> grey[10:50, 10:50] = -100
    >>> grey[25:30, 44:50] = -210                                  # a lamp on the right edge
    >>> filled, share = without_glare(grey, -150.0, half_way_edge(grey, -150.0))
    >>> int((filled > -150).sum()), int((grey > -150).sum()), round(share, 3)
    (1600, 1570, 0.019)
    """
    step, outline = edge.contrast, edge.outline
    if not len(outline.chain) or step <= 0.0:
        return grey, 0.0
    area = float(outline.area)
    bays = [bay for bay in _bays(outline.chain.astype(np.int64)) if _of_a_lamp(bay, area)]
    light = [bay for bay in bays if _is_lighter(grey, outline, bay, _LIGHTER * step)]
    if not light:
        return grey, 0.0
    window = _around(np.concatenate(light), grey.shape)
    filling = _filled_in(light, window)
    filling[outline.part(window) > 0] = 0
    return _filled(grey, level, step, outline, filling, window), float(np.count_nonzero(filling)) / area


def glare_notice(share: float, name: str) -> tuple[Notice, ...]:
    """Return what to say of bays filled, `share` of the body's area, unless too small to notice."""
    if share < _TOLD:
        return ()
    message = (
        f"{name}: filled bays of {100 * share:.2g} % of the body's area in its outline, taken for reflections"
        "; give a mask in stack.toml if they are the body's own"
    )
    return (Notice("glare-filled", message),)


def _of_a_lamp(bay: IntArray, area: float) -> bool:
    """Return whether a bay is neither too small nor too large beside a body of that many pixels."""
    return _SMALLEST <= abs(_area(bay)) <= _LARGEST * area


def _is_lighter(grey: Levels, outline: Outline, bay: IntArray, least: float) -> bool:
    """Return whether a bay is lighter than the plate before its mouth."""
    window = _around(bay, grey.shape)
    inside, beside, part = _filled_in([bay], window), outline.part(window) == 0, grey[window]
    around = cv2.dilate(inside, np.ones((_BEFORE, _BEFORE), np.uint8))
    own, before = part[(inside > 0) & beside], part[(around > inside) & beside]
    return bool(len(own) and len(before) and _lighter(own, before) >= least)


def _around(points: IntArray, shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return rows and columns of the picture about some points (x, y)."""
    low = np.maximum(points.min(axis=0) - _BEFORE, 0)
    high = np.minimum(points.max(axis=0) + _BEFORE + 1, shape[1::-1])
    return slice(int(low[1]), int(high[1])), slice(int(low[0]), int(high[0]))


def _filled_in(bays: list[IntArray], window: tuple[slice, slice]) -> Mask:
    """Return 1 where bays are, in a window."""
    rows, columns = window
    inside = np.zeros((rows.stop - rows.start, columns.stop - columns.start), np.uint8)
    for bay in bays:
        cv2.fillPoly(inside, [(bay - [columns.start, rows.start]).astype(np.int32)], 1)
    return inside


def _filled(
    grey: Levels, level: float, step: float, outline: Outline, bays: Mask, window: tuple[slice, slice]
) -> Levels:
    """Return the grey levels with the body continued over the bays, which lie in a window."""
    if not bays.any():
        return grey
    body = cv2.GaussianBlur((outline.part(window) | bays).astype(np.float32), (0, 0), _SOFT)
    put = np.asarray(level + (body - 0.5) * step, dtype=np.float32)
    near = cv2.dilate(bays, np.ones((3, 3), np.uint8)) > 0
    filled = grey.copy()
    np.copyto(filled[window], np.maximum(grey[window], put.astype(grey.dtype)), where=near)
    return filled


def _lighter(own: Levels, before: Levels) -> float:
    """Return by how much the lightest pixels of a bay are lighter than the plate before it."""
    return float(np.median(before) - np.percentile(own, 15))


def _bays(outline: IntArray) -> list[IntArray]:
    """Return the ways around narrow, deep bays of an outline (x, y), the largest first, none twice."""
    n = len(outline)
    steps = np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1)
    along = np.concatenate([[0.0], np.cumsum(np.concatenate([steps, steps]))])
    twice = np.concatenate([outline, outline])
    x, y = np.ascontiguousarray(twice.T)
    widest = max(_WIDEST[0] * along[n], _WIDEST[1])
    sense = np.sign(_area(outline))
    found: list[tuple[float, int, int]] = []
    for lag in np.unique(np.round(np.geomspace(6, max(7, min(4 * widest, n // 3)), 24)).astype(int)):
        mouth = (x[lag : lag + n] - x[:n]) ** 2 + (y[lag : lag + n] - y[:n]) ** 2  # squared
        way = along[lag : lag + n] - along[:n]
        deep = (mouth <= widest**2) & (way**2 >= _DEEP**2 * np.maximum(mouth, 1))
        found += [(_area(twice[k : k + lag + 1]), int(k), int(lag)) for k in np.flatnonzero(deep)]
    taken = np.zeros(n, dtype=bool)
    bays = []
    for area, k, lag in sorted(found, key=lambda one: sense * one[0]):
        own = np.arange(k, k + lag + 1) % n
        if area * sense < 0 and not taken[own].any():
            taken[own] = True
            bays.append(outline[own])
    return bays


def _area(way: IntArray) -> float:
    """Return the signed area that a way and the chord between its ends enclose, square pixels."""
    x, y = way[:, 0].astype(np.float64), way[:, 1].astype(np.float64)
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
