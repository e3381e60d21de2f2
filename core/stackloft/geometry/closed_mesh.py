r"""Volume and area of a closed triangle surface, and whether it is one.

::

        c                 each triangle and an origin o span a tetrahedron of signed volume
       / \                (a − o)·(b − o)×(c − o)/6; over a closed surface they sum to the volume
      /   \               inside, wherever o is
     a-----b              closed: every edge is run as often one way as the other
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class EdgeFaults:
    """Edges that are not run equally often in both directions, by what is wrong with them."""

    rims: IntArray
    """(k, 2) vertex numbers: edges of one triangle alone, the rim of a hole."""
    disagreeing: IntArray
    """(k, 2): two triangles run them the same way, so one is turned over."""
    crowded: IntArray
    """(k, 2): three and more triangles that do not pair off; no surface has such an edge."""

    @property
    def count(self) -> int:
        """How many there are; 0: closed and oriented."""
        return len(self.rims) + len(self.disagreeing) + len(self.crowded)


def edge_faults(faces: IntArray) -> EdgeFaults:
    """Return the edges that keep a surface from being closed and oriented.

    Parameters
    ----------
    faces : (t, 3) int array
        Vertex numbers of each triangle, in order.

    Examples
    --------
    >>> faults = edge_faults(np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3]]))
    >>> faults.rims.tolist(), faults.count
    ([[0, 2], [0, 3], [2, 3]], 3)
    """
    tail, head = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    kept = tail != head
    tail, head = tail[kept], head[kept]
    if not len(tail):
        nothing = np.zeros((0, 2), dtype=np.int64)
        return EdgeFaults(nothing, nothing, nothing)
    low, high = np.minimum(tail, head), np.maximum(tail, head)
    span = int(high.max()) + 1
    edges, which, uses = np.unique(low * span + high, return_inverse=True, return_counts=True)
    balance = np.bincount(which, np.where(tail < head, 1.0, -1.0))
    pairs = np.column_stack([edges // span, edges % span])
    off = balance != 0
    return EdgeFaults(pairs[off & (uses == 1)], pairs[off & (uses == 2)], pairs[off & (uses > 2)])


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
    return edge_faults(faces).count


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
