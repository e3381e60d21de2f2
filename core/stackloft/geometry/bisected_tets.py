r"""Tetrahedra with chosen edges cut in two, and which edges keep elements from being bent.

::

        v                    a face with two edges on one smooth rim (a - v - b) has no angle left at v once
      /   \    rim           these are curved along it; cutting a - b leaves half the angle to each of two.
     a --m-- b               Likewise an element with two faces side by side on one smooth surface: the
                             edge opposite to the one they share is cut
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

WIDE = 110.0
"""Angle, degrees, above which two rim edges of a face are taken for parts of one smooth line."""
_EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
_FACES = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])  # each opposite to a vertex


def bisected(nodes: FloatArray, elements: IntArray, edges: IntArray) -> tuple[FloatArray, IntArray]:
    """Return nodes and elements with `edges` cut at their middles.

    Of two edges of one element only the first is cut.

    Parameters
    ----------
    nodes : (n, 3) array
    elements : (m, 4) int array
    edges : (k, 2) int array

    Examples
    --------
    >>> nodes, elements = bisected(np.eye(4, 3), np.array([[0, 1, 2, 3]]), np.array([[1, 0], [2, 3]]))
    >>> nodes[4].tolist(), elements.tolist()
    ([0.5, 0.5, 0.0], [[0, 4, 2, 3], [4, 1, 2, 3]])
    """
    taken = np.zeros(len(elements), dtype=bool)
    points, whole, halves = [nodes], elements.copy(), []
    count = len(nodes)
    for edge in np.unique(np.sort(edges, axis=1), axis=0) if len(edges) > 1 else edges:
        around = np.flatnonzero(np.isin(elements, edge).sum(axis=1) == 2)
        if not len(around) or taken[around].any():
            continue
        taken[around] = True
        first, second = np.sort(edge)
        own = elements[around]
        halves.append(np.where(own == first, count, own))
        whole[around] = np.where(own == second, count, own)
        points.append(nodes[edge].mean(axis=0)[None])
        count += 1
    return np.concatenate(points), np.concatenate([whole, *halves])


def edges_in_the_way(nodes: FloatArray, elements: IntArray, faces: IntArray, regions: IntArray) -> IntArray:
    """Return (k, 2) the edges that must be cut before boundary faces can be bent.

    Parameters
    ----------
    nodes : (n, 3) array
    elements : (m, 4) int array
    faces : (b, 3) int array
        The boundary.
    regions : (b,) int array
        The smooth part of the surface that each face belongs to.
    """
    found = [_ears(nodes, faces, regions), _doubles(elements, faces, regions)]
    return np.concatenate(found)


def _ears(nodes: FloatArray, faces: IntArray, regions: IntArray) -> IntArray:
    """Return the third edges of faces with two edges on one rim."""
    sides = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)  # each opposite to a vertex
    _, which = np.unique(sides, axis=0, return_inverse=True)
    which = which.ravel()
    owner = np.repeat(regions, 3)
    low = np.full(which.max(initial=-1) + 1, np.iinfo(np.int64).max)
    high = np.full(len(low), -1)
    np.minimum.at(low, which, owner)
    np.maximum.at(high, which, owner)
    rim = (low != high)[which].reshape(-1, 3)
    found = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        into, out = nodes[faces[:, i]] - nodes[faces[:, k]], nodes[faces[:, j]] - nodes[faces[:, k]]
        length = np.linalg.norm(into, axis=1) * np.linalg.norm(out, axis=1)
        wide = (into * out).sum(axis=1) < np.cos(np.radians(WIDE)) * length
        found.append(faces[rim[:, i] & rim[:, j] & wide][:, [i, j]])
    return np.concatenate(found)


def _doubles(elements: IntArray, faces: IntArray, regions: IntArray) -> IntArray:
    """Return the edges opposite to those that two faces of an element share on one smooth surface."""
    every = np.sort(elements[:, _FACES], axis=2).reshape(-1, 3)
    known = {
        tuple(face): int(region)
        for face, region in zip(np.sort(faces, axis=1).tolist(), regions, strict=True)
    }
    rim = np.isin(elements, faces).sum(axis=1) == 4
    found = []
    for k in np.flatnonzero(rim).tolist():
        own = [known.get(tuple(face), -1) for face in every[4 * k : 4 * k + 4].tolist()]
        found += [elements[k, [a, b]] for a, b in _EDGES.tolist() if own[a] == own[b] >= 0]
    return np.array(found, dtype=np.int64).reshape(-1, 2)
