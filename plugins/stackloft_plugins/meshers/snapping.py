r"""The boundary nodes of a mesh put where they belong: on surface, sharp edge or corner.

::

    faces  →  region: the one they lie on, and look the same way as
    nodes  →  faces of one region: on it; of two: on the edge between them; of more: on a corner
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from stackloft.model.arrays import FloatArray, IntArray
from stackloft_plugins.meshers.boundary_target import BoundaryTarget

_ALIKE = 0.7
"""Cosine between a face and the triangle beside it above which nobody else is asked."""


def regions_of_faces(nodes: FloatArray, faces: IntArray, target: BoundaryTarget, reach: float) -> IntArray:
    """Return the region of each boundary face, (b,).

    Parameters
    ----------
    nodes : (n, 3) array, mm
    faces : (b, 3) int array
        Vertices, outward.
    target : BoundaryTarget
    reach : float
        mm: regions that are so much further off than the nearest one are asked for their normal as well.
    """
    middle = nodes[faces].mean(axis=1)
    normal = _normals(nodes, faces)
    _, nearest, distance = target.near.project(middle)
    found = target.regions.region[nearest].copy()
    alike = np.einsum("ij,ij->i", target.regions.normals[nearest], normal)
    odd = np.flatnonzero(alike < _ALIKE)
    if target.regions.count == 1 or not len(odd):
        return found
    best = alike[odd].copy()
    surface, regions = target.surface, target.regions
    for number in range(regions.count):
        mine = np.flatnonzero(regions.region == number)
        near = type(target.near)(surface.vertices, surface.faces[mine])
        _, which, off = near.project(middle[odd])
        score = np.einsum("ij,ij->i", regions.normals[mine[which]], normal[odd])
        better = (off <= distance[odd] + reach) & (score > best + 1e-6)
        found[odd[better]], best[better] = number, score[better]
    return found


def snapped(
    nodes: FloatArray, faces: IntArray, regions: IntArray, target: BoundaryTarget, chosen: IntArray
) -> FloatArray:
    """Return `nodes` with the `chosen` ones where the regions of their faces want them.

    Parameters
    ----------
    nodes : (n, 3) array, mm
    faces : (b, k) int array
        All nodes of each boundary face.
    regions : (b,) int array
        Of each face.
    target : BoundaryTarget
    chosen : (c,) int array
        Nodes to be placed; all of them lie on boundary faces.
    """
    pairs = np.unique(np.column_stack([faces.ravel(), np.repeat(regions, faces.shape[1])]), axis=0)
    pairs = pairs[np.isin(pairs[:, 0], chosen)]
    node, start, count = np.unique(pairs[:, 0], return_index=True, return_counts=True)
    placed = nodes.copy()
    first, last = pairs[start, 1], pairs[start + count - 1, 1]
    for number in np.unique(first[count == 1]):
        mine = node[(count == 1) & (first == number)]
        placed[mine] = target.on_region(int(number))(nodes[mine])
    double = count == 2
    for a, b in np.unique(np.column_stack([first, last])[double], axis=0):
        mine = node[double & (first == a) & (last == b)]
        placed[mine] = _on_edge(nodes[mine], int(a), int(b), target)
    several = node[count > 2]
    if len(several):
        _, triangle, _ = target.near.project(nodes[several])
        for number in np.unique(target.regions.region[triangle]):
            mine = several[target.regions.region[triangle] == number]
            placed[mine] = target.on_region(int(number))(nodes[mine])
    return placed


def corners_taken(placed: FloatArray, candidates: IntArray, target: BoundaryTarget) -> FloatArray:
    """Return `placed` with the nearest of `candidates` at each corner, each used once."""
    corners = target.corners()
    if not len(corners) or not len(candidates):
        return placed
    result = placed.copy()
    found = cKDTree(placed[candidates]).query(corners, k=min(4, len(candidates)))
    distance, which = (np.asarray(part).reshape(len(corners), -1) for part in found)
    used: set[int] = set()
    for corner in np.argsort(distance[:, 0]):
        free = [int(k) for k in which[corner] if int(k) not in used]
        if free:
            used.add(free[0])
            result[candidates[free[0]]] = corners[corner]
    return result


def _on_edge(points: FloatArray, a: int, b: int, target: BoundaryTarget) -> FloatArray:
    """Return points on the edge between two regions, or where they do not meet on the nearer of the two."""
    on_edge = target.on_edges(a, b)
    if on_edge is not None:
        return on_edge(points)
    one, other = target.on_region(a)(points), target.on_region(b)(points)
    nearer = np.linalg.norm(one - points, axis=1) <= np.linalg.norm(other - points, axis=1)
    return np.where(nearer[:, None], one, other)


def _normals(nodes: FloatArray, faces: IntArray) -> FloatArray:
    a, b, c = (nodes[faces[:, k]] for k in range(3))
    cross = np.cross(b - a, c - a)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    return np.asarray(np.divide(cross, length, out=np.zeros_like(cross), where=length > 0.0))
