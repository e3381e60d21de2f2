r"""Lagrange triangles and tetrahedra of order 1 to 3: their nodes, in VTK's order, and their shapes.

::

          2                     3
          | \                  /|\         vertices first, then the nodes of each edge from its first to its
          9   7               / | \        second vertex, then one node per face where order is 3
          |     \            /  |  \
          8  9.   6         0---|---2      triangle edges  (0,1) (1,2) (2,0)
          |         \        \  |  /       tetrahedron edges (0,1) (1,2) (2,0) (0,3) (1,3) (2,3)
          0--3---4---1        \ | /        tetrahedron faces (0,1,3) (1,2,3) (0,2,3) (0,1,2)
                               \|/
                                1          positive: (X₁ − X₀) · (X₂ − X₀) × (X₃ − X₀) > 0

Order 2 keeps one node per edge, in the middle. This is the order of VTK_TETRA, VTK_QUADRATIC_TETRA and
VTK_LAGRANGE_TETRAHEDRON (and of meshio's ``tetra10``); Gmsh exchanges the last two edges.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))
TET_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
TET_FACES = ((0, 1, 3), (1, 2, 3), (0, 2, 3), (0, 1, 2))
"""The faces whose inner nodes come last at order 3, in this order."""
OUTWARD_FACES = ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1))
"""The same faces, each counter-clockwise seen from outside a positive tetrahedron."""

TRIANGLE_NODES = {1: 3, 2: 6, 3: 10}
TET_NODES = {1: 4, 2: 10, 3: 20}
"""Nodes of an element by order."""


@lru_cache
def triangle_lattice(order: int) -> IntArray:
    """Return (k, 3) barycentric coordinates times `order` of a triangle's nodes.

    Examples
    --------
    >>> triangle_lattice(2).tolist()
    [[2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1]]
    """
    return _lattice(3, order, TRIANGLE_EDGES, ((0, 1, 2),))


@lru_cache
def tet_lattice(order: int) -> IntArray:
    """Return (m, 4) barycentric coordinates times `order` of a tetrahedron's nodes.

    Examples
    --------
    >>> tet_lattice(3)[[4, 5, 19]].tolist()
    [[2, 1, 0, 0], [1, 2, 0, 0], [1, 1, 1, 0]]
    """
    return _lattice(4, order, TET_EDGES, TET_FACES)


def _lattice(
    corners: int, order: int, edges: tuple[tuple[int, int], ...], faces: tuple[tuple[int, int, int], ...]
) -> IntArray:
    unit = np.eye(corners, dtype=np.int64)
    rows = [order * unit[k] for k in range(corners)]
    rows += [(order - j) * unit[a] + j * unit[b] for a, b in edges for j in range(1, order)]
    if order == 3:
        rows += [unit[a] + unit[b] + unit[c] for a, b, c in faces]
    return np.array(rows)


@lru_cache
def face_nodes(order: int) -> IntArray:
    """Return (4, k) which of a tetrahedron's nodes are those of each of its `OUTWARD_FACES`, in their order.

    Examples
    --------
    >>> face_nodes(2).tolist()[0]
    [0, 1, 3, 4, 8, 7]
    """
    place = {tuple(row): number for number, row in enumerate(tet_lattice(order).tolist())}
    rows = []
    for face in OUTWARD_FACES:
        lifted = np.zeros((len(triangle_lattice(order)), 4), dtype=np.int64)
        lifted[:, face] = triangle_lattice(order)
        rows.append([place[tuple(row)] for row in lifted.tolist()])
    return np.array(rows)


def exponents(dimension: int, degree: int) -> IntArray:
    """Return the (k, dimension) exponents of all monomials up to `degree`.

    Examples
    --------
    >>> exponents(2, 1).tolist()
    [[0, 0], [0, 1], [1, 0]]
    """
    grid = np.indices((degree + 1,) * dimension).reshape(dimension, -1).T
    return np.asarray(grid[grid.sum(axis=1) <= degree], dtype=np.int64)


@lru_cache
def _coefficients(dimension: int, order: int) -> FloatArray:
    """Return the monomial coefficients of the nodes' shape functions, one per column."""
    lattice = triangle_lattice(order) if dimension == 2 else tet_lattice(order)
    points = lattice[:, 1:] / order
    powers = exponents(dimension, order)
    return np.asarray(np.linalg.inv((points[:, None, :] ** powers).prod(axis=2)))


def shape_values(dimension: int, order: int, points: FloatArray) -> FloatArray:
    """Return (g, k) shape functions at `points` (g, dimension) of the unit simplex.

    Examples
    --------
    >>> shape_values(2, 1, np.array([[0.2, 0.3]])).round(12).tolist()
    [[0.5, 0.2, 0.3]]
    """
    powers = exponents(dimension, order)
    monomials = (points[:, None, :] ** powers).prod(axis=2)
    return np.asarray(monomials @ _coefficients(dimension, order))


def shape_slopes(dimension: int, order: int, points: FloatArray) -> FloatArray:
    """Return (dimension, g, k) derivatives of the shape functions at `points`."""
    powers = exponents(dimension, order)
    slopes = []
    for axis in range(dimension):
        lowered = powers.copy()
        lowered[:, axis] = np.maximum(lowered[:, axis] - 1, 0)
        monomials = powers[:, axis] * (points[:, None, :] ** lowered).prod(axis=2)
        slopes.append(monomials @ _coefficients(dimension, order))
    return np.stack(slopes)
