r"""The level half-way between a body's edge and the background beside it.

::

    grey
      |######\                 b: mean of the band inside
      |       \
      |--------*-----------    level = (a + b) / 2
      |         \
      |          \.......      a: mean of the band outside
      +------------------- across the boundary
         [ b ]    [ a ]        bands, 1 to 2 pixels from it

A camera's blur is symmetric, so the boundary of a straight edge lies where the grey level is half-way,
whatever the blur; Otsu's threshold may lie anywhere between the two peaks, and moves the boundary with
it. The bands are close to the boundary, and equally so, because what counts is the grey of the body's edge,
be it skin or flesh: a step blurred alike on both sides is half-way at the same place however little of it
the bands see. (Half-maximum edge definition, as in ISO 12233 edge profiles and in coordinate metrology by CT,
VDI/VDE 2630-1.2 "ISO 50 %".)
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from stackloft.model.arrays import IntArray
from stackloft_plugins.segmenters.body_outline import Outline, main_outline
from stackloft_plugins.segmenters.body_window import Mask
from stackloft_plugins.segmenters.grey import Grey, Levels

_ROUNDS = 8
_NEARBY = 15  # pixels
_SETTLED = 0.001  # of the contrast
_STEEPEST = 0.9
_GIVEN_BACK, _NEAR_BY = 0.4, 0.05
"""Of a small shift of the level, what the bands of a camera's edges usually move along with it, so that the
second look is near enough more often than not. Small: of the contrast."""
_SAME_BODY = 1.3
"""Times the area at the first level, or by which it may shrink; beyond, the level has left the body's edge
for juice, shadow or flesh."""


@dataclass(frozen=True, slots=True, eq=False)
class Edge:
    """What the two bands beside the boundary say; grey levels with the body above the background."""

    body: float
    background: float
    noise: float
    """Standard deviation in the outer band, robust."""
    span: float
    """From the 5th to the 95th hundredth of the outer band."""
    outline: Outline

    @property
    def mask(self) -> Mask:
        """1 inside the body's outline."""
        return self.outline.mask()

    @property
    def level(self) -> float:
        """Half-way between the two."""
        return 0.5 * (self.body + self.background)

    @property
    def contrast(self) -> float:
        """Step across the boundary."""
        return self.body - self.background


def half_way_edge(grey: Levels, level: float) -> Edge | None:
    """Return the edge of the largest object, its level settled half-way (secant iteration).

    On a blurred edge the bands move along with the level they are to set, so that plain repetition would
    creep towards the half-way level.

    Parameters
    ----------
    grey : ndarray, (rows, columns)
        Body above background.
    level : float
        A first threshold that tells the classes apart, such as Otsu's.

    Returns
    -------
    Edge or None
        None when nothing lies above `level`, or nothing but the body is in the picture.

    Examples
    --------
    >>> grey = np.full((60, 60), 20, dtype=np.float32)
    >>> grey[20:40, 20:40] = 120
    >>> half_way_edge(grey, 30.0).level
    70.0
    """
    edge = edge_at(grey, level)
    if edge is None:
        return None
    last, last_off = level, edge.level - level
    slope = _GIVEN_BACK if abs(last_off) < _NEAR_BY * abs(edge.contrast) else 0.0
    area = edge.outline.area
    for _ in range(_ROUNDS):
        if abs(last_off) <= _SETTLED * abs(edge.contrast):
            break
        level = last + last_off / (1.0 - slope)
        nearer = edge_at(grey, level)
        if nearer is None or not area <= _SAME_BODY * nearer.outline.area <= _SAME_BODY**2 * area:
            break
        edge = nearer
        off = edge.level - level
        slope = float(np.clip(1.0 + (off - last_off) / (level - last), 0.0, _STEEPEST))
        last, last_off = level, off
    return edge


def edge_at(grey: Levels, level: float) -> Edge | None:
    """Return what lies on either side of the boundary of the largest object above `level`."""
    outline = main_outline(grey, level)
    within, beyond = (grey.ravel()[band].astype(np.float32) for band in (outline.inner, outline.outer))
    if not len(within) or not len(beyond):
        return None
    background = _middle_mean(beyond)
    spread = 1.4826 * float(np.median(np.abs(beyond - background)))
    low, high = np.percentile(beyond, (5, 95))
    return Edge(_middle_mean(within), background, spread, float(high - low), outline)


def grain(grey: Levels, band: IntArray) -> float:
    """Return the outer band's noise without what changes slowly: shadow and juice beside the body."""
    values = grey.ravel()[band]
    weight, levels = np.zeros((2, *grey.shape), np.float32)
    weight.ravel()[band], levels.ravel()[band] = 1.0, values
    near, mean = (cv2.blur(each, (_NEARBY, _NEARBY)).ravel()[band] for each in (weight, levels))
    return 1.4826 * float(np.median(np.abs(values - mean / near)))


def _middle_mean(values: Grey) -> float:
    """Return the mean of the middle half: robust as the median, but not bound to whole grey levels."""
    quarter = len(values) // 4
    ordered = np.sort(values)
    return float(ordered[quarter : len(values) - quarter].mean(dtype=np.float64))
