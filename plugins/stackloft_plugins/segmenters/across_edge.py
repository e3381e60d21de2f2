r"""The grey levels on lines across a body's boundary, thousands of them, evenly along its outline.

::

          |  |  |           A line runs along the outline's normal, through the point at which the grey level
     _.--´*--*--*`-._       crosses the boundary's; the body's first.
          |  |  |
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft_plugins.segmenters.body_outline import Outline
from stackloft_plugins.segmenters.cell_means import CellMeans
from stackloft_plugins.segmenters.grey import Grey, Levels

ACROSS: FloatArray = np.linspace(-6.0, 6.0, 49)
"""Outward distances at which grey levels are taken, pixels."""
REACH = float(ACROSS[-1])
MOST = 2000
"""Boundary pixels, evenly chosen, that are looked at."""
_BASE = 5
"""Pixels on either side along the outline that its direction is taken from."""
_FEWEST = 40
"""Pixels of an outline: a shorter one has no direction."""


@dataclass(frozen=True, slots=True, eq=False)
class Across:
    """What is seen across a boundary, (n) lines within the picture."""

    points: FloatArray
    """(n, 2) x, y on the boundary"""
    levels: Grey
    """(n, len(ACROSS)), in the picture's unit"""
    looked_for: int
    """Lines, those included that leave the picture."""


def across(picture: Levels, outline: Outline, level: float, local: CellMeans | None = None) -> Across:
    """Return what is seen across the boundary that lies along an outline, at a level.

    Parameters
    ----------
    picture : array (rows, columns)
        Body above background.
    outline : Outline
    level : float
    local : CellMeans, optional
        What is taken off the picture first.
    """
    points, normals = _boundary_points(picture, outline, level, local)
    x, y = (points[:, k, None] + ACROSS * normals[:, k, None] for k in (0, 1))
    rows, columns = picture.shape
    ends = np.stack([x[:, 0], x[:, -1]]), np.stack([y[:, 0], y[:, -1]])
    inside = np.all([(at >= 0) & (at <= side - 1) for at, side in zip(ends, (columns, rows), strict=True)], 0)
    whole = inside.all(axis=0)
    if not whole.all():
        x, y, points = x[whole], y[whole], points[whole]
    return Across(points, _seen(picture, x, y, local), len(whole))


def _seen(picture: Levels, x: NDArray[Any], y: NDArray[Any], local: CellMeans | None) -> Grey:
    """Return the grey levels between the pixels, (n, k)."""
    if not len(x):
        return np.empty(x.shape, np.float32)
    x, y = x.astype(np.float32), y.astype(np.float32)
    known = picture if picture.dtype.type in {np.float32, np.int16} else picture.astype(np.float32)
    seen = np.asarray(cv2.remap(known, x, y, cv2.INTER_LINEAR), np.float32)
    return seen if local is None else seen - local.between(x, y)


def _boundary_points(
    picture: Levels, outline: Outline, level: float, local: CellMeans | None
) -> tuple[FloatArray, FloatArray]:
    """Return points (x, y) of the outline on the level, to a part of a pixel, and outward normals."""
    pixels = outline.chain.astype(np.float64)
    if len(pixels) < _FEWEST:
        return np.empty((0, 2)), np.empty((0, 2))
    along = _chain_mean(np.roll(pixels, -_BASE, axis=0)) - _chain_mean(np.roll(pixels, _BASE, axis=0))
    sense = 1.0 if cv2.contourArea(outline.chain, oriented=True) > 0.0 else -1.0
    normals = sense * np.stack([along[:, 1], -along[:, 0]], axis=1)
    length = np.linalg.norm(normals, axis=1)
    chosen = np.flatnonzero(length > _BASE)[:: max(1, len(pixels) // MOST)]
    normals = normals[chosen] / length[chosen, None]
    return _onto_level(picture, level, pixels[chosen], normals, local), normals


def _chain_mean(pixels: FloatArray) -> FloatArray:
    """Return each pixel of a closed chain averaged with its neighbours, which takes the stairs out."""
    return np.asarray(sum(np.roll(pixels, k, axis=0) for k in range(-3, 4)) / 7.0)


def _onto_level(
    picture: Levels, level: float, pixels: FloatArray, normals: FloatArray, local: CellMeans | None
) -> FloatArray:
    """Return the pixels moved along their normals to where the grey level crosses `level`."""
    t = np.linspace(-2.0, 3.0, 41)
    x, y = (pixels[:, k, None] + t * normals[:, k, None] for k in (0, 1))
    seen = _seen(picture, x, y, local)
    below = seen < level
    first = np.maximum(below.argmax(axis=1), 1)
    line = np.arange(len(pixels))
    high, low = seen[line, first - 1].astype(np.float64), seen[line, first].astype(np.float64)
    fraction = np.clip((high - level) / np.where(high > low, high - low, 1.0), 0.0, 1.0)
    where = t[first - 1] + fraction * (t[1] - t[0])
    return np.asarray(pixels + where[:, None] * normals)
