r"""Whether curved tetrahedra are turned over anywhere: bounds of det J by its Bézier coefficients.

An element of order p has det J of degree 3(p − 1). A polynomial lies within the hull of its Bézier
coefficients, and reaches those at the corners::

        coefficients                min b   ≤  det J  ≤  max b       for every point of the element
        .   .   .   .               det J at the corners = b there
        corner ... corner           not sharp: cut into 8, as often as needed

George & Borouchaki (2012), Construction of tetrahedral meshes of degree two, IJNME 90:1156; Johnen, Remacle &
Geuzaine (2013), Geometrical validity of curvilinear finite elements, J. Comp. Phys. 233:359.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import factorial

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.lagrange_simplex import TET_EDGES, TET_NODES, exponents, shape_slopes

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

DEEPEST = 8
"""Most halvings; what is still undecided then counts as turned over."""
SHARP = 0.01
"""Wanted sharpness of the smallest scaled Jacobian."""
_BATCH = 20_000

_ORDERS = {count: order for order, count in TET_NODES.items()}


@dataclass(frozen=True, slots=True)
class JacobianBounds:
    """Bounds of each element's smallest det J, scaled so that the regular straight tetrahedron has 1."""

    low: FloatArray
    """(m,) the smallest is no less"""
    high: FloatArray
    """(m,) the smallest is no more"""


def jacobian_bounds(elements: FloatArray) -> JacobianBounds:
    """Return bounds of each element's smallest scaled Jacobian.

    Scaled means √2·det J over the largest product, among the corners, of the lengths of the three straight
    edges that meet there: for straight elements it is the scaled Jacobian of Verdict (Stimpson
    et al. 2007).

    Parameters
    ----------
    elements : (m, 4|10|20, 3) array
        Nodes of each element, mm.

    Returns
    -------
    JacobianBounds
        ``low > 0`` wherever the element is nowhere turned over.

    Examples
    --------
    >>> corner = np.vstack([np.zeros(3), np.eye(3)])
    >>> jacobian_bounds(np.stack([corner, corner[[0, 2, 1, 3]]])).low.round(6).tolist()
    [0.707107, -0.707107]
    """
    pieces = bezier_jacobians(elements) * jacobian_scale(elements)[:, None]
    owner = np.arange(len(pieces))
    low = np.full(len(pieces), np.inf)
    high = pieces[:, _corners(pieces.shape[1])].min(axis=1)
    for depth in range(DEEPEST + 1):
        floors = pieces.min(axis=1)
        np.minimum.at(high, owner, pieces[:, _corners(pieces.shape[1])].min(axis=1))
        again = _undecided(floors, high[owner], high.min(initial=np.inf)) & (depth < DEEPEST)
        np.minimum.at(low, owner[~again], floors[~again])
        if not again.any():
            break
        pieces, owner = _cut(pieces[again]), np.repeat(owner[again], 8)
    return JacobianBounds(np.minimum(low, high), high)


def _undecided(floors: FloatArray, high: FloatArray, best: float) -> BoolArray:
    """Return which pieces to cut: those that may turn over, or lower the smallest of all by `SHARP`."""
    return np.asarray((high > 0.0) & ((floors <= 0.0) | (floors < best - SHARP)) & (floors < high))


def bezier_jacobians(elements: FloatArray) -> FloatArray:
    """Return (m, k) Bézier coefficients of det J, degree 3(p − 1), in the order of `exponents`.

    Examples
    --------
    >>> corner = np.vstack([np.zeros(3), np.eye(3)])
    >>> bezier_jacobians(2.0 * corner[None]).tolist()
    [[8.0]]
    """
    order = _ORDERS[elements.shape[1]]
    degree = 3 * (order - 1)
    slopes = shape_slopes(3, order, exponents(3, degree) / max(degree, 1))
    values = np.empty((len(elements), slopes.shape[1]))
    for start in range(0, len(elements), _BATCH):
        part = slice(start, start + _BATCH)
        columns = [slopes[axis] @ elements[part] for axis in range(3)]
        values[part] = np.einsum("mgd,mgd->mg", columns[0], np.cross(columns[1], columns[2]))
    return np.asarray(values @ bernstein_inverse(degree).T)


@lru_cache
def bernstein_inverse(degree: int) -> FloatArray:
    """Return the matrix from a polynomial's values on the lattice of `degree` to its Bézier coefficients."""
    return np.asarray(np.linalg.inv(_bernstein(degree, exponents(3, degree) / max(degree, 1))))


def _bernstein(degree: int, points: FloatArray) -> FloatArray:
    """Return (g, k) Bernstein polynomials of `degree` at `points` (g, 3) of the unit tetrahedron."""
    powers = exponents(3, degree)
    powers = np.column_stack([degree - powers.sum(axis=1), powers])
    counts = [factorial(degree) / np.prod([factorial(k) for k in row]) for row in powers.tolist()]
    coordinates = np.column_stack([1.0 - points.sum(axis=1), points])
    return np.asarray((coordinates[:, None, :] ** powers).prod(axis=2) * counts)


@lru_cache
def _corners(count: int) -> IntArray:
    """Return which of `count` coefficients are det J at the corners."""
    degree = {1: 0, 20: 3, 84: 6}[count]
    powers = exponents(3, degree)
    powers = np.column_stack([degree - powers.sum(axis=1), powers])
    return np.flatnonzero((powers == degree).any(axis=1))


@lru_cache
def _cutters(count: int) -> FloatArray:
    """Return (8, count, count) matrices from coefficients to those of the eight halved tetrahedra."""
    degree = {1: 0, 20: 3, 84: 6}[count]
    lattice = exponents(3, degree) / max(degree, 1)
    inverse = bernstein_inverse(degree)
    corner = np.vstack([np.zeros(3), np.eye(3)])
    middle = {frozenset((a, b)): 0.5 * (corner[a] + corner[b]) for a, b in TET_EDGES}
    whole = [[corner[a], *(middle[frozenset((a, b))] for b in range(4) if b != a)] for a in range(4)]
    m01, m12, m20, m03, m13, m23 = (middle[frozenset(edge)] for edge in TET_EDGES)
    whole += [[m01, m23, a, b] for a, b in ((m12, m20), (m20, m03), (m03, m13), (m13, m12))]
    pieces = [np.array(one) for one in whole]
    points = [one[0] + lattice @ (one[1:] - one[0]) for one in pieces]
    return np.stack([inverse @ _bernstein(degree, at) for at in points])


def _cut(pieces: FloatArray) -> FloatArray:
    """Return the coefficients on the eight halves of each piece, (8 n, k)."""
    halves = np.einsum("hij,nj->nhi", _cutters(pieces.shape[1]), pieces)
    return np.asarray(halves.reshape(-1, pieces.shape[1]))


def jacobian_scale(elements: FloatArray) -> FloatArray:
    """Return √2 over the largest product of three straight edges that meet at a corner; 0 where all are 0."""
    corners = elements[:, :4]
    length = {frozenset(edge): np.linalg.norm(corners[:, edge[1]] - corners[:, edge[0]], axis=1)
              for edge in TET_EDGES}  # fmt: skip
    products = [np.prod([length[frozenset((a, b))] for b in range(4) if b != a], axis=0) for a in range(4)]
    largest = np.maximum.reduce(products)
    return np.asarray(np.divide(np.sqrt(2.0), largest, out=np.zeros_like(largest), where=largest > 0.0))
