"""Where a skin folds: half-way between rows its sections cross themselves, or it runs back along the axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.bezier_patch import bernstein, evaluate, patch_planes
from stackloft.geometry.shoelace import polygon_area
from stackloft.geometry.simple_polygon import crosses_itself

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

SLIP = 0.003
"""Largest part of a section's area in a loop that it makes by crossing itself: a traced notch that slips by a
fraction of a pixel is no fold."""
_HALF = bernstein(np.array([0.5]))
_ALONG = bernstein(np.array([0.0, 0.5]))
_ACROSS = bernstein(np.linspace(0.0, 1.0, 9))


def folded_rows(patches: FloatArray) -> BoolArray:
    """Return which rows of patches fold.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array
        Bézier control points [v, u], mm; z is constant along each row's rims and increases across it.

    Returns
    -------
    (rows,) bool array
        True where z does not increase all along v (the surface's Jacobian changes sign there), or where
        the section half-way crosses itself by more than `SLIP` of its area.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(12) / 12
    >>> ring = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    >>> from stackloft.geometry.skin import Rows, skin
    >>> tube = np.stack([ring, ring + [0, 0, 1.0], ring + [0, 0, 2.0]])
    >>> folded_rows(skin(Rows(tube, np.zeros((3, 12), bool), np.zeros(3, bool), (None, None)))).tolist()
    [False, False]
    """
    half = evaluate(patches, _HALF, _ALONG)[:, :, 0, :, :2]
    sections = half.reshape(len(patches), -1, 2)
    crossing = crosses_itself(sections)
    crossing[crossing] = [_largest_lobe(polygon) > SLIP for polygon in sections[crossing]]
    z = np.tensordot(_ACROSS, patch_planes(patches)[:, 0, 2], 1)  # (9, columns, rows)
    rise = np.diff(z, axis=0)
    length = np.abs(z[-1] - z[0])
    back = (rise < -1e-6 * np.maximum(length, 1e-300)).any(axis=(0, 1))
    return np.asarray(crossing | back)


def _largest_lobe(polygon: FloatArray) -> float:
    """Return the largest part of a polygon's area that lies in a loop between two of its edges that cross."""
    start, edge = polygon, np.roll(polygon, -1, axis=0) - polygon
    between = start[None] - start[:, None]
    cross = edge[:, None, 0] * edge[None, :, 1] - edge[:, None, 1] * edge[None, :, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (between[..., 0] * edge[None, :, 1] - between[..., 1] * edge[None, :, 0]) / cross
    found = (t > 0.0) & (t < 1.0)
    found &= found.T
    whole = abs(polygon_area(polygon))
    worst = 0.0
    for i, j in np.argwhere(np.triu(found, 2)):
        lobe = np.concatenate([[start[i] + t[i, j] * edge[i]], polygon[i + 1 : j + 1]])
        part = abs(polygon_area(lobe))
        worst = max(worst, min(part, abs(whole - part)) / whole)
    return worst
