"""How much more area a skin between two loops has than one that goes straight from one to the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.bezier_patch import bernstein, evaluate
from stackloft.geometry.patch_integrals import patch_areas
from stackloft.geometry.polygon_distance import inside_grid
from stackloft.geometry.shoelace import polygon_centroid

FloatArray = NDArray[np.float64]

GRID = 128
"""Nodes along each side of the box in which the loops' difference is counted."""
WEAK = 0.3
"""Loops that share less than this fraction of the smaller one lie beside each other, not one on the other."""
SWAY = 0.25
"""How far aside a half-way section may sway, in gaps."""
_ROUND = bernstein(np.arange(4) / 4)
_RIMS = bernstein(np.array([0.0, 0.5, 1.0]))


def areas_beyond(patches: FloatArray) -> tuple[FloatArray, float]:
    """Return the area, mm², by which every row of patches exceeds what there is to go over; and the whole.

    That is the area between the rims seen along the axis, and the wall between them; a skin that goes
    straight over has less: the root of the squares, piece by piece. It may bulge, and then is longer
    half-way, and goes out and back again: the wall's length is Simpson's mean with the half-way section's,
    the area between the rims at least what the half-way section's differs from both, and the wall as high as
    the way over the half-way section's centre.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array
        Bézier control points [v, u], mm; z is constant along each row's rims.

    Returns
    -------
    (rows,) array
        0 or less for sound skins, positive where columns slipped round.
    float

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(24) / 24
    >>> from stackloft.geometry.skin import Rows, skin
    >>> ring = np.stack([9 * np.cos(t), 3 * np.sin(t), 0 * t], axis=1)
    >>> tube = np.stack([ring, ring + [0, 0, 1.0], np.roll(ring, 6, axis=0) + [0, 0, 2.0]])
    >>> rows = Rows(tube, np.zeros((3, 24), bool), np.zeros(3, bool), (None, None))
    >>> (areas_beyond(skin(rows))[0] > 10.0).tolist()
    [False, True]
    """
    areas = patch_areas(patches, degree=4).sum(axis=1)
    rims = evaluate(patches, _RIMS, _ROUND)  # (rows, columns, 3, 4, 3)
    loops = rims.transpose(4, 2, 1, 3, 0).reshape(3, 3, -1, len(patches))
    return areas - _needed(loops, areas), float(areas.sum())


def _needed(loops: FloatArray, areas: FloatArray) -> FloatArray:
    """Return what there is to go over from the first to the last of three loops each, (rows,) mm².

    Of (3, 3, k, rows) loops: coordinate, loop, vertex. Their difference is counted only where an area,
    (rows,), needs it.
    """
    x, y = loops[:2] - loops[:2, :, :1]  # each loop from its own first point
    across, up = (np.concatenate([each[:, 1:], each[:, :1]], axis=1) - each for each in (x, y))
    lengths = np.array([1.0, 4.0, 1.0]) / 6.0 @ np.sqrt(across * across + up * up).sum(axis=1)
    sizes = np.abs(0.5 * (x * up - y * across).sum(axis=1))  # (3, rows)
    out = np.abs(np.diff(sizes, axis=0)).sum(axis=0)
    gaps = loops[2, 2, 0] - loops[2, 0, 0]
    needed = areas.copy()
    for k in np.flatnonzero(areas > lengths * gaps + out):
        low, half, high = np.moveaxis(loops[:2, ..., k], 0, -1)
        gap = float(gaps[k])
        if sizes[:, k].min() > 0.0:
            middle = 0.5 * (polygon_centroid(low) + polygon_centroid(high))
            gap = _swayed(gap, polygon_centroid(half) - middle)
        apart, shared = _difference(low, high)
        if shared < WEAK * sizes[::2, k].min():  # the wall slants from one to the other
            gap = float(np.hypot(gap, np.linalg.norm(polygon_centroid(high) - polygon_centroid(low))))
        needed[k] = lengths[k] * gap + max(float(out[k]), apart)
    return needed


def _swayed(gap: float, aside: FloatArray) -> float:
    """Return the way over a gap when the half-way section lies aside, as under a stack pushed askew.

    A little: what lies farther aside is no sway.
    """
    sway = float(np.linalg.norm(aside))
    return 2.0 * float(np.hypot(0.5 * gap, sway)) if sway < SWAY * gap else gap


def _difference(low: FloatArray, high: FloatArray) -> tuple[float, float]:
    """Return the areas that lie in one of two polygons alone, and in both, mm²."""
    both = np.concatenate([low, high])
    least, most = both.min(axis=0), both.max(axis=0)
    t = (np.arange(GRID) + 0.5) / GRID
    x, y = least[:, None] + t * (most - least)[:, None]
    one, two = (inside_grid(x, y, p, np.roll(p, -1, axis=0)) for p in (low, high))
    box = float(np.prod(most - least))
    return float((one != two).mean()) * box, float((one & two).mean()) * box
