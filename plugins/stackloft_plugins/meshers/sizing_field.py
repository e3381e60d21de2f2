r"""Wanted edge lengths from place to place: short where the surface bends, longer away from there.

::

    ____                        size = radius of curvature / factor on the surface, no less than a twentieth
        \___  short here        of the largest, and growing by half the distance from there
            \
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from stackloft.geometry.surface_regions import SurfaceRegions
from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.tri_mesh import TriMesh

_GRID = 32
"""Grid steps along the longest side."""
_FINEST = 0.05
"""Smallest size as a part of the largest."""
_GROWTH = 0.5
"""mm longer per mm of distance."""
_NEAR = 64
"""Vertices asked for each grid point."""
_CUBE = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))
"""A cube as six tetrahedra round its diagonal (Kuhn); corners are numbered x + 2y + 4z."""


def sizing_field(
    surface: TriMesh, regions: SurfaceRegions, largest: float, factor: float
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return a background mesh round `surface`: points (k, 3), tetrahedra (l, 4), edge lengths (k,), mm.

    Parameters
    ----------
    surface : TriMesh
    regions : SurfaceRegions
        Of the same surface; sharp edges do not count as curvature.
    largest : float
        Edge length where nothing bends, mm.
    factor : float
        Elements per radius of curvature.
    """
    used = np.unique(surface.faces)
    bend = curvature(surface, regions)[used]
    size = np.clip(1.0 / np.maximum(factor * bend, 1e-300), _FINEST * largest, largest)
    low, high = surface.vertices[used].min(axis=0), surface.vertices[used].max(axis=0)
    step = float((high - low).max()) / _GRID
    counts = np.ceil((high - low) / step).astype(np.int64) + 3
    axes = [start - step + step * np.arange(count) for start, count in zip(low, counts, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    count = min(_NEAR, len(used))
    found = cKDTree(surface.vertices[used]).query(points, k=count)
    distance, near = (np.asarray(part).reshape(len(points), -1) for part in found)
    wanted = (size[near] + _GROWTH * distance).min(axis=1)
    return points, _cells(counts), np.minimum(wanted, largest)


def curvature(surface: TriMesh, regions: SurfaceRegions) -> FloatArray:
    """Return (n,) about the largest normal curvature at each vertex, 1/mm; sharp edges are left out.

    From each smooth edge: the angle between its two triangles over the mean of their heights above it.
    """
    faces = surface.faces
    tail, head = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    apex = np.roll(faces, -2, axis=1).ravel()
    low, high = np.minimum(tail, head), np.maximum(tail, head)
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.lexsort((owner, high, low))
    low, high, owner, apex = low[order], high[order], owner[order], apex[order]
    first = np.flatnonzero((low[1:] == low[:-1]) & (high[1:] == high[:-1]))
    first = first[regions.region[owner[first]] == regions.region[owner[first + 1]]]
    one, other = owner[first], owner[first + 1]
    along = np.clip(np.einsum("ij,ij->i", regions.normals[one], regions.normals[other]), -1.0, 1.0)
    start, end = surface.vertices[low[first]], surface.vertices[high[first]]
    height = sum(_height(surface.vertices[apex[first + k]], start, end) for k in (0, 1))
    bend = 2.0 * np.arccos(along) / np.maximum(height, 1e-300)
    result = np.zeros(len(surface.vertices))
    for vertex in (low[first], high[first]):
        np.maximum.at(result, vertex, bend)
    return result


def _height(apex: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return how far each apex is from the line of its edge."""
    along = end - start
    area = np.linalg.norm(np.cross(along, apex - start), axis=1)
    return np.asarray(area / np.maximum(np.linalg.norm(along, axis=1), 1e-300))


def _cells(counts: IntArray) -> IntArray:
    """Return the cubes of a grid of `counts` points as tetrahedra."""
    nx, ny, nz = (int(count) for count in counts)
    index = np.arange(nx * ny * nz).reshape(nx, ny, nz)
    corners = np.stack(
        [
            index[x : nx - 1 + x, y : ny - 1 + y, z : nz - 1 + z].ravel()
            for z in (0, 1)
            for y in (0, 1)
            for x in (0, 1)
        ],
        axis=1,
    )
    return np.asarray(corners[:, np.array(_CUBE)].reshape(-1, 4))
