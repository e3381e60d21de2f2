r"""Volume and area of a closed triangle surface, and whether it is one.

::

        c                 each triangle and an origin o span a tetrahedron of signed volume
       / \                (a − o)·(b − o)×(c − o)/6; over a closed surface they sum to the volume
      /   \               inside, wherever o is
     a-----b              closed: every edge is run as often one way as the other
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def unmatched_edges(faces: IntArray) -> int:
    """Return how many edges are not run equally often in both directions; 0: closed and oriented.

    Parameters
    ----------
    faces : (t, 3) int array
        Vertex numbers of each triangle, in order.

    Examples
    --------
    >>> tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    >>> unmatched_edges(tetrahedron), unmatched_edges(tetrahedron[:3])
    (0, 3)
    """
    tail, head = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    kept = tail != head
    tail, head = tail[kept], head[kept]
    if not len(tail):
        return 0
    low, high = np.minimum(tail, head), np.maximum(tail, head)
    edge = low * (int(high.max()) + 1) + high
    _, which = np.unique(edge, return_inverse=True)
    balance = np.bincount(which, np.where(tail < head, 1.0, -1.0))
    return int(np.count_nonzero(balance))


def mesh_integrals(vertices: FloatArray, faces: IntArray) -> tuple[float, float]:
    """Return signed volume (mm³, positive when faces point outwards) and area (mm²).

    The volume by the divergence theorem, summed over tetrahedra (Lien & Kajiya 1984, IEEE CG&A
    4(10):35) about the surface's own middle, so that a body far from the origin loses no digits.

    Parameters
    ----------
    vertices : (n, 3) array, mm
    faces : (t, 3) int array

    Examples
    --------
    >>> corner = np.vstack([np.zeros(3), np.eye(3)])
    >>> volume, area = mesh_integrals(corner, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
    >>> round(volume * 6, 12), round(area, 6)
    (1.0, 2.366025)
    """
    used = vertices[faces.ravel()]
    local = vertices - 0.5 * (used.min(axis=0) + used.max(axis=0))
    a, b, c = (local[faces[:, k]] for k in range(3))
    cross = np.cross(b - a, c - a)
    return float((a * cross).sum()) / 6.0, 0.5 * float(np.linalg.norm(cross, axis=1).sum())
