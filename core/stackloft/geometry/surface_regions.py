r"""A triangle surface taken apart at its sharp edges: regions, the edges between them, and the corners.

::

        +---------+
       /   B     /|         two triangles that meet at more than `angle` lie in different regions, and
      +---------+ |         the edge between them is sharp; where sharp edges end, meet or turn, and where
      |         |C|         a cone ends in a point, there is a corner
      |    A    | +
      +---------+/
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heapify, heappop, heappush

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

SHARP = 25.0
"""Degrees between the normals of triangles that lie in different regions."""
_FLAT = 1e-9
"""Part of the surface's size that a plane region may be uneven by."""
_POINTED = 0.5
"""Radians that the angles round a vertex fall short of a full turn at the point of a cone."""


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceRegions:
    """Regions of a triangle surface."""

    region: IntArray
    """(t,) of each triangle"""
    plane: BoolArray
    """(r,) whether a region lies in one plane"""
    normals: FloatArray
    """(t, 3) outward, of length one; zero for triangles without area"""
    edges: IntArray
    """(e, 2) vertices of the sharp edges"""
    sides: IntArray
    """(e, 2) the two regions of each, the lower first; the same twice where a region meets itself"""
    corners: IntArray
    """(c,) vertices"""

    @property
    def count(self) -> int:
        """How many regions there are."""
        return len(self.plane)


def surface_regions(
    vertices: FloatArray, faces: IntArray, angle: float = SHARP, least: float = 0.0
) -> SurfaceRegions:
    """Return the regions of a closed, oriented surface.

    Parameters
    ----------
    vertices : (n, 3) array, mm
    faces : (t, 3) int array
    angle : float
        Degrees between triangles that lie in different regions.
    least : float
        Part of the whole area below which a region goes to its neighbour; above 0, sharp edges within a
        region do not count.

    Examples
    --------
    >>> corner = np.vstack([np.zeros(3), np.eye(3)])
    >>> found = surface_regions(corner, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
    >>> found.count, len(found.edges), len(found.corners), found.plane.all()
    (4, 6, 4, np.True_)
    """
    normals = _normals(vertices, faces)
    pairs, edges = _neighbours(faces)
    across = np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]])
    solid = (normals != 0.0).any(axis=1)
    whole = solid[pairs[:, 0]] & solid[pairs[:, 1]]
    smooth = whole & (across >= np.cos(np.radians(angle)))
    joined = coo_array((np.ones(smooth.sum()), tuple(pairs[smooth].T)), shape=(len(faces),) * 2)
    parts = connected_components(joined, directed=False)[1].astype(np.int64)
    region = _adopted(parts, solid, pairs)
    if least > 0.0:
        region = _without_crumbs(region, pairs, _lengths(vertices, edges), _areas(vertices, faces), least)
    count = int(region.max()) + 1
    sharp = region[pairs[:, 0]] != region[pairs[:, 1]]
    if not least > 0.0:
        sharp |= whole & ~smooth
    sides, sharp = np.sort(region[pairs[sharp]], axis=1), edges[sharp]
    plane = np.array([_is_plane(vertices, faces[region == k], normals[region == k]) for k in range(count)])
    corners = _corners(vertices, faces, sharp, sides)
    return SurfaceRegions(region, plane, normals, sharp, sides, corners)


def _adopted(region: IntArray, solid: BoolArray, pairs: IntArray) -> IntArray:
    """Return the regions numbered from 0, a triangle without area in that of one of its neighbours.

    It must not join the two regions whose common edge it lies along.
    """
    result = np.where(solid, region, -1).astype(np.int64)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    while True:
        taking = both[(result[both[:, 0]] < 0) & (result[both[:, 1]] >= 0)]
        if not len(taking):
            break
        result[taking[:, 0]] = result[taking[:, 1]]
    return np.unique(result, return_inverse=True)[1].reshape(-1).astype(np.int64)


def _without_crumbs(
    region: IntArray, pairs: IntArray, lengths: FloatArray, areas: FloatArray, least: float
) -> IntArray:
    """Return the regions with each that is smaller than `least` in the one it has the longest border with."""
    size = np.bincount(region, areas)
    enough = least * float(areas.sum())
    borders = _borders(region[pairs], lengths, len(size))
    heir = np.arange(len(size))
    waiting = [(float(size[k]), int(k)) for k in np.flatnonzero(size < enough)]
    heapify(waiting)
    while waiting:
        own, crumb = heappop(waiting)
        if heir[crumb] != crumb or own != size[crumb] or not borders[crumb]:
            continue
        into = max(borders[crumb], key=lambda k: (borders[crumb][k], -k))
        heir[crumb] = into
        size[into] += own
        for other, length in borders[crumb].items():
            del borders[other][crumb]
            if other != into:
                borders[other][into] = borders[into][other] = borders[into].get(other, 0.0) + length
        borders[crumb] = {}
        if size[into] < enough:
            heappush(waiting, (float(size[into]), into))
    while (heir != heir[heir]).any():
        heir = heir[heir]
    return np.unique(heir[region], return_inverse=True)[1].reshape(-1).astype(np.int64)


def _borders(sides: IntArray, lengths: FloatArray, count: int) -> list[dict[int, float]]:
    """Return the length of every region's border with each of its neighbours."""
    apart = sides[:, 0] != sides[:, 1]
    between, which = np.unique(np.sort(sides[apart], axis=1), axis=0, return_inverse=True)
    total = np.bincount(which.ravel(), lengths[apart], len(between))
    borders: list[dict[int, float]] = [{} for _ in range(count)]
    for (a, b), length in zip(between.tolist(), total.tolist(), strict=True):
        borders[a][b] = borders[b][a] = length
    return borders


def _lengths(vertices: FloatArray, edges: IntArray) -> FloatArray:
    return np.asarray(np.linalg.norm(vertices[edges[:, 1]] - vertices[edges[:, 0]], axis=1))


def _areas(vertices: FloatArray, faces: IntArray) -> FloatArray:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.asarray(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1))


def _normals(vertices: FloatArray, faces: IntArray) -> FloatArray:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    cross = np.cross(b - a, c - a)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    longest = np.max([np.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    solid = length > 1e-7 * longest[:, None] ** 2
    return np.asarray(np.divide(cross, length, out=np.zeros_like(cross), where=solid & (length > 0.0)))


def _neighbours(faces: IntArray) -> tuple[IntArray, IntArray]:
    """Return (k, 2) triangles that share an edge, and its vertices; crowded edges pair in their order."""
    tail, head = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    low, high = np.minimum(tail, head), np.maximum(tail, head)
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.lexsort((owner, high, low))
    low, high, owner = low[order], high[order], owner[order]
    same = (low[1:] == low[:-1]) & (high[1:] == high[:-1])
    run = np.cumsum(np.concatenate([[True], ~same]))
    place = np.arange(len(low)) - np.searchsorted(run, run)
    first = np.flatnonzero(same & (place[:-1] % 2 == 0))
    return np.column_stack([owner[first], owner[first + 1]]), np.column_stack([low[first], high[first]])


def _is_plane(vertices: FloatArray, faces: IntArray, normals: FloatArray) -> bool:
    used = vertices[np.unique(faces)]
    size = float(np.ptp(vertices, axis=0).max())
    return bool(np.abs((used - used[0]) @ _mean(normals)).max() <= _FLAT * size)


def _mean(normals: FloatArray) -> FloatArray:
    whole = normals.sum(axis=0)
    length = np.linalg.norm(whole)
    return np.asarray(whole / length if length > 0.0 else whole)


def _corners(vertices: FloatArray, faces: IntArray, sharp: IntArray, sides: IntArray) -> IntArray:
    degree = np.bincount(sharp.ravel(), minlength=len(vertices))
    marked = (degree > 0) & (degree != 2)
    marked |= _turning(vertices, sharp, sides, degree)
    marked |= (degree == 0) & (_missing_angle(vertices, faces) > _POINTED)
    return np.flatnonzero(marked)


def _turning(vertices: FloatArray, sharp: IntArray, sides: IntArray, degree: IntArray) -> BoolArray:
    """Return (n,) where two sharp edges meet at more than `SHARP`, or part other regions."""
    marked = np.zeros(len(vertices), dtype=bool)
    ends = np.concatenate([sharp, sharp[:, ::-1]])
    between = np.concatenate([sides, sides])
    order = np.argsort(ends[:, 0], kind="stable")
    ends, between = ends[order], between[order]
    two = degree[ends[:, 0]] == 2
    ends, between = ends[two].reshape(-1, 2, 2), between[two].reshape(-1, 2, 2)
    if len(ends):
        along = vertices[ends[:, :, 1]] - vertices[ends[:, :, 0]]
        along /= np.maximum(np.linalg.norm(along, axis=2, keepdims=True), 1e-300)
        straight = -np.einsum("ij,ij->i", along[:, 0], along[:, 1])
        other = (between[:, 0] != between[:, 1]).any(axis=1)
        marked[ends[(straight < np.cos(np.radians(SHARP))) | other, 0, 0]] = True
    return marked


def _missing_angle(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return 2π less the angles round each vertex."""
    total = np.zeros(len(vertices))
    for k in range(3):
        apex = vertices[faces[:, k]]
        a, b = vertices[faces[:, k - 2]] - apex, vertices[faces[:, k - 1]] - apex
        lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
        cosine = np.divide((a * b).sum(axis=1), lengths, out=np.ones_like(lengths), where=lengths > 0.0)
        np.add.at(total, faces[:, k], np.arccos(np.clip(cosine, -1.0, 1.0)))
    return np.asarray(2.0 * np.pi - total)
