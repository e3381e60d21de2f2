"""Names for the parts of a mesh's boundary: what a simulation sets its conditions on."""

from __future__ import annotations

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tet_mesh import FIRST_FACE, LAST_FACE, SIDE
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.meshers.boundary_target import BoundaryTarget

_NAMED = 50
"""Most regions that get a name each."""
_ALONG = 1e-9


def boundary_groups(
    regions: IntArray, target: BoundaryTarget, solid: LoftedSolid | TriMesh
) -> tuple[IntArray, tuple[str, ...]]:
    """Return (b,) the group of each boundary face, and the groups' names.

    Of a loft: ``side``, ``first-face`` and ``last-face``, the plane regions across the stack at its two ends.
    Of a surface: ``face-1``, ``face-2``, … parted by its sharp edges, largest first; ``side`` when there is
    one region or more than 50.

    Parameters
    ----------
    regions : (b,) int array
        Region of each boundary face of the mesh.
    target : BoundaryTarget
    solid : LoftedSolid or TriMesh
        What is meshed.
    """
    if isinstance(solid, LoftedSolid):
        return _of_loft(regions, target, solid)
    count = target.regions.count
    if not 1 < count <= _NAMED:
        return np.zeros(len(regions), dtype=np.int64), (SIDE,)
    areas = np.bincount(target.regions.region, _areas(target), count)
    rank = np.argsort(np.argsort(-areas, kind="stable"), kind="stable")
    return np.asarray(rank[regions]), tuple(f"face-{k + 1}" for k in range(count))


def _of_loft(
    regions: IntArray, target: BoundaryTarget, solid: LoftedSolid
) -> tuple[IntArray, tuple[str, ...]]:
    axis = np.linalg.inv(solid.affine[:3, :3])[2]  # a stack's z from bench millimetres
    height = target.surface.vertices @ axis
    low, high = float(height.min()), float(height.max())
    group = np.zeros(target.regions.count, dtype=np.int64)
    for number in np.flatnonzero(target.regions.plane):
        own = height[target.surface.faces[target.regions.region == number].ravel()]
        if np.ptp(own) <= _ALONG * (high - low):
            group[number] = 1 if own[0] <= low + _ALONG * (high - low) else 0
            group[number] = 2 if own[0] >= high - _ALONG * (high - low) else group[number]
    return np.asarray(group[regions]), (SIDE, FIRST_FACE, LAST_FACE)


def _areas(target: BoundaryTarget) -> FloatArray:
    a, b, c = (target.surface.vertices[target.surface.faces[:, k]] for k in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1))
