r"""Which patch lies beyond each rim of a patch, found by where the rims lie.

::

           v = 1 (3)
         +-----------+
    u=0  |           |  u=1        rims are numbered 0: u = 0, 1: u = 1, 2: v = 0, 3: v = 1
    (0)  |           |  (1)
         +-----------+
           v = 0 (2)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from stackloft.geometry.bezier_patch import bernstein

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class PatchRims:
    """What lies beyond the rims."""

    beyond: IntArray
    """(k, 4) the patch there; -1: none"""
    entered: IntArray
    """(k, 4) through which of its own rims it is entered"""
    back: NDArray[np.bool_]
    """(k, 4) whether that rim runs the other way"""


def patch_rims(patches: FloatArray) -> PatchRims:
    """Return what lies beyond the rims of patches (k, 4, 4, 3); nothing where a rim is a pole."""
    p = patches
    rims = np.stack([p[:, :, 0], p[:, :, 3], p[:, 0], p[:, 3]], axis=1).reshape(-1, 4, 3)
    middle = np.einsum("k,nkd->nd", bernstein(np.array([0.5]))[0], rims)
    size = float(np.ptp(p.reshape(-1, 3), axis=0).max())
    found = cKDTree(middle).query(middle, k=2, distance_upper_bound=1e-8 * size)
    distance, near = np.asarray(found[0]), np.asarray(found[1])
    own = np.arange(len(rims))
    other = np.where(near[:, 0] == own, near[:, -1], near[:, 0])
    long = np.linalg.norm(rims - middle[:, None], axis=2).max(axis=1) > 1e-8 * size
    there = long & np.isfinite(distance).all(axis=1) & (other != own) & (other < len(rims))
    other = np.where(there, other, 0)
    same = np.linalg.norm(rims[:, 0] - rims[other, 0], axis=1)
    turned = same > np.linalg.norm(rims[:, 0] - rims[other, 3], axis=1)
    patch = np.where(there, other // 4, -1).reshape(-1, 4)
    return PatchRims(patch, (other % 4).reshape(-1, 4), turned.reshape(-1, 4))
