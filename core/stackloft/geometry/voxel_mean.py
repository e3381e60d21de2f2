r"""Where the half-way level of voxel means lies beside a curved surface.

::

      z ^   ________               A voxel's grey is the mean over its box: h × h in the picture, t
        |  |     \  |  t           across it. On a plane surface the grey is half-way where the plane
        |  |      \ |              goes through the box's middle. A curved surface
        |  |_______\|
        |     h   *-> p                p = s·z + ½ b·z² + m·q·z − ½ κ·q²
                                   (p outwards, q along the contour, z across the slices) leaves more of the
    box on one side than on the other: half of it is filled where the contour is off by

        E[½ b·z² + m·q·z − ½ κ·q²],

    the mean taken over the part of the plane p = s·z that lies in the box centred on it.

First order in the curvatures, for any slope s. A wall (s = 0) gives b·t²/24 − κ·h²/24: contours enclose
the slab's mean area, A + A″·t²/24, less a third of a pixel for each turn (∮ h²κ/(24 cos²θ) ds = h²/3, as
pixels lie askew by θ). On a flank with |s|·t ≫ h the plane leaves the box by its sides, z² has the mean
(h/s)²/12, and how thick the slab is does not matter. For isotropic Gaussian blur the same reasoning gives
−½ σ²(κ₁ + κ₂) (Bouma, Vilanova, van Vliet & Gerritsen 2005, IEEE TPAMI 27:1501).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_FLAT = 1e-12  # slope: below, the surface stands upright
_ASKEW = 1e-12  # of a normal's component: below, the boundary runs along the pixels


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceShape:
    """A surface at points of its contour on one slice; lengths in mm."""

    normals: FloatArray
    """(k, 2) outward unit normals of the contour, (x, y)"""
    slope: FloatArray
    """(k) dp/dz along the normal"""
    bend: FloatArray
    """(k) d²p/dz², 1/mm"""
    twist: FloatArray
    """(k) d²p/dq dz, 1/mm; q runs to the left of the normal"""
    curvature: FloatArray
    """(k) of the contour, 1/mm; positive where the body is convex"""


def half_way_shift(surface: SurfaceShape, box: FloatArray) -> FloatArray:
    """Return how far outwards of the surface the half-way level lies, in the plane of the picture.

    Parameters
    ----------
    surface : SurfaceShape
    box : (k, 3) array
        What the mean is taken over at each point: along x, y and z, mm.

    Returns
    -------
    (k,) array
        mm.

    Examples
    --------
    >>> def shift(slope, bend, curvature):
    ...     values = (np.array([each]) for each in (slope, bend, 0.0, curvature))
    ...     found = half_way_shift(SurfaceShape(np.array([[1.0, 0.0]]), *values), np.array([[1.0, 1.0, 3.0]]))
    ...     return round(24.0 * float(found[0]), 9)
    >>> shift(0.0, 0.0, 1.0), shift(0.0, 1.0, 0.0), shift(10.0, 1.0, 0.0)  # −h²κ, t²b, (h / s)²·b
    (-1.0, 9.0, 0.01)
    """
    half = 0.5 * box
    reach = (np.abs(surface.normals) * half[:, :2]).sum(axis=1)
    steep = np.maximum(np.abs(surface.slope), _FLAT)
    z = np.minimum(half[:, 2], reach / steep)[:, None] * _NODES
    low, high = _chords(surface.normals, surface.slope[:, None] * z, half)
    length, middle = np.maximum(high - low, 0.0), 0.5 * (high + low)
    weight = _WEIGHTS * length
    total = weight.sum(axis=1)
    zz = (weight * z**2).sum(axis=1) / total
    qz = (weight * middle * z).sum(axis=1) / total
    qq = (weight * (middle**2 + length**2 / 12.0)).sum(axis=1) / total
    return np.asarray(0.5 * surface.bend * zz + surface.twist * qz - 0.5 * surface.curvature * qq)


def _chords(normals: FloatArray, p: FloatArray, half: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return from which q to which the line at distance `p` from the pixel's middle, (k, n), lies in it."""
    cosine, sine = normals[:, :1], normals[:, 1:]
    low, high = np.full_like(p, -np.inf), np.full_like(p, np.inf)
    for factor, offset, side in ((-sine, p * cosine, half[:, :1]), (cosine, p * sine, half[:, 1:2])):
        over = np.where(np.abs(factor) < _ASKEW, _ASKEW, factor)
        one, other = (-side - offset) / over, (side - offset) / over
        low, high = np.maximum(low, np.minimum(one, other)), np.minimum(high, np.maximum(one, other))
    return low, high
