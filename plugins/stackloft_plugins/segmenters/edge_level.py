"""The level at the body's edge, read off the mean grey profile across the whole boundary.

The half-way level between bands beside the boundary is right for a plain step. Where a skin is darker or
lighter than the flesh, the inner band sees a mixture, and the boundary moves by some tenths of a pixel. The
mean profile across the boundary, thousands of pixels put together, shows background, skin, flesh and blur
apart; a model of them fitted to it says where the edge lies and which grey level it has there.
"""

from __future__ import annotations

import cv2
import numpy as np

from stackloft.geometry.edge_profile import EdgeFit, fit_edge
from stackloft.model.arrays import BoolArray, FloatArray
from stackloft_plugins.segmenters.grey import Grey
from stackloft_plugins.segmenters.half_way import Edge

REACH = 6.0
"""Pixels looked at on either side."""
FURTHEST = 0.6
"""Pixels; an edge further from the half-way level's boundary is not believed."""
MOST = 2000
"""Boundary pixels, evenly chosen, that the mean is taken over."""
POOREST = 0.03
"""Misfit, as a fraction of the step, beyond which the model does not describe the edge."""
_BASE = 5
"""Pixels on either side along the outline that its direction is taken from."""
SHARPEST = 0.45
"""Pixels; a sharper blur is the pixels' own area, and the "skin" its difference from a Gaussian."""


def edge_level(grey: Grey, edge: Edge) -> float:
    """Return the grey level at the edge.

    Parameters
    ----------
    grey : ndarray, (rows, columns)
        Body above background.
    edge : Edge
        What the bands beside the boundary say; its level is the first guess, and the answer when the
        profile shows no edge that the model describes.

    Returns
    -------
    float
    """
    distance = np.linspace(-REACH, REACH, 49)
    profile = _mean_profile(grey, edge, distance)
    if profile is None:
        return edge.level
    fit = fit_edge(distance, profile)
    if fit is None or not _tells_more(fit):
        return edge.level
    at_edge = float(np.interp(fit.position, distance, profile))
    at_boundary = float(np.interp(0.0, distance, profile))
    return edge.level + at_edge - at_boundary


def _tells_more(fit: EdgeFit) -> bool:
    """Return whether the fit is to be believed over the half-way level, which is right without a skin."""
    return fit.skin > 0.0 and fit.blur > SHARPEST and fit.misfit < POOREST and abs(fit.position) < FURTHEST


def _mean_profile(grey: Grey, edge: Edge, distance: FloatArray) -> FloatArray | None:
    """Return the mean of the middle half of the grey levels at each outward distance."""
    points, normals = boundary_points(grey, edge)
    if len(points) < 40:
        return None
    seen, inside = seen_across(grey, points, normals, distance)
    if inside.sum() < 0.5 * len(points):
        return None
    ordered = np.sort(np.ascontiguousarray(seen.T), axis=1)
    quarter = ordered.shape[1] // 4
    return np.asarray(ordered[:, quarter : ordered.shape[1] - quarter].mean(axis=1, dtype=np.float64))


def seen_across(
    grey: Grey, points: FloatArray, normals: FloatArray, distance: FloatArray
) -> tuple[Grey, BoolArray]:
    """Return the grey levels along the normals, and at which points these stay within the picture.

    Returns
    -------
    seen : array (inside.sum(), len(distance))
    inside : array (len(points)) of bool
    """
    at = (points[:, None, :] + distance[None, :, None] * normals[:, None, :]).astype(np.float32)
    rows, columns = grey.shape
    inside = np.asarray(((at >= 0) & (at <= [columns - 1, rows - 1])).all(axis=(1, 2)))
    if not inside.any():
        return np.empty((0, len(distance)), dtype=np.float32), inside
    picture = grey.astype(np.float32, copy=False)
    seen = cv2.remap(picture, at[inside, :, 0], at[inside, :, 1], cv2.INTER_LINEAR)
    return np.asarray(seen, dtype=np.float32), inside


def boundary_points(grey: Grey, edge: Edge) -> tuple[FloatArray, FloatArray]:
    """Return points (x, y) of the outline on the level, to a part of a pixel, and outward normals."""
    outlines, _ = cv2.findContours(edge.mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    outline = max(outlines, key=len)
    pixels = outline[:, 0, :].astype(np.float64)
    if len(pixels) < 40:
        return np.empty((0, 2)), np.empty((0, 2))
    along = _chain_mean(np.roll(pixels, -_BASE, axis=0)) - _chain_mean(np.roll(pixels, _BASE, axis=0))
    sense = 1.0 if cv2.contourArea(outline, oriented=True) > 0.0 else -1.0
    normals = sense * np.stack([along[:, 1], -along[:, 0]], axis=1)
    length = np.linalg.norm(normals, axis=1)
    chosen = np.flatnonzero(length > _BASE)[:: max(1, len(pixels) // MOST)]
    normals = normals[chosen] / length[chosen, None]
    return _onto_level(grey, edge.level, pixels[chosen], normals), normals


def _chain_mean(pixels: FloatArray) -> FloatArray:
    """Return each pixel of a closed chain averaged with its neighbours, which takes the stairs out."""
    return np.asarray(sum(np.roll(pixels, k, axis=0) for k in range(-3, 4)) / 7.0)


def _onto_level(grey: Grey, level: float, pixels: FloatArray, normals: FloatArray) -> FloatArray:
    """Return the pixels moved along their normals to where the grey level crosses `level`."""
    t = np.linspace(-2.0, 3.0, 41)
    at = (pixels[:, None, :] + t[None, :, None] * normals[:, None, :]).astype(np.float32)
    seen = cv2.remap(grey.astype(np.float32, copy=False), at[..., 0], at[..., 1], cv2.INTER_LINEAR)
    below = seen < level
    first = np.maximum(below.argmax(axis=1), 1)
    line = np.arange(len(pixels))
    high, low = seen[line, first - 1].astype(np.float64), seen[line, first].astype(np.float64)
    fraction = np.clip((high - level) / np.where(high > low, high - low, 1.0), 0.0, 1.0)
    where = t[first - 1] + fraction * (t[1] - t[0])
    return np.asarray(pixels + where[:, None] * normals)
