r"""Directions of lattice lines with weights for integrals over all directions, at any voxel spacing.

::

    slices far apart        . . . . . . . . .      lines of a lattice run along whole lattice vectors;
                                                   few of them are short when the slices are far
    pitch 10, pixel 1       . . . . . . . . .      apart, and most of those lie in the slice plane
                              \_ (7, 0, 1)

For each member of a quasi-uniform set the lattice vector nearest in direction is taken, among those not
longer than a few pitches; a direction's weight is the share of the sphere nearest to it (spherical Voronoi
cell), corrected as little as possible so that even spherical harmonics up to degree 4 integrate exactly.
Crofton's formula with Voronoi weights at the actual spacing: Legland, Kiêu & Devaux (2007), Image Anal.
Stereol. 26:83. The correction is the least-squares one of scattered quadrature points (Sloan & Womersley
2004, Extremal systems of points and numerical integration on the sphere).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import SphericalVoronoi

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

DIRECTIONS = 49
"""Members of the quasi-uniform set."""
REACH = 2.5
"""Longest lattice vector taken, in steps along the coarsest lattice axis."""
DEGREE = 4
"""Even spherical harmonics up to this degree are integrated exactly."""
_STEPS = 256  # places along a direction at which lattice points are looked for
THIRTEEN = np.array(
    [
        *(
            [0, 0, 1],
            [0, 1, 0],
            [1, 0, 0],
            [0, 1, 1],
            [0, 1, -1],
            [1, 0, 1],
            [1, 0, -1],
            [1, 1, 0],
            [1, -1, 0],
        ),
        *([1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]),
    ]
)
"""Half of the 26 neighbours of a voxel; the first three are the axes."""


@dataclass(frozen=True, slots=True, eq=False)
class LatticeDirections:
    """Lattice vectors with weights."""

    steps: IntArray
    """(n, 3) whole steps along the lattice axes, without a common factor; no two parallel."""
    lengths: FloatArray
    """(n,) their lengths, mm."""
    weights: FloatArray
    """(n,) positive, sum 1: ``weights @ f(direction)`` is the mean of an even f over the sphere."""


def spaced_directions(basis: FloatArray) -> LatticeDirections:
    """Return directions chosen for the lattice at hand.

    Parameters
    ----------
    basis : (3, 3) array
        Columns are the lattice's steps, mm; they need not be at right angles. A turned or mirrored
        lattice gets the same steps and weights.

    Returns
    -------
    LatticeDirections
        At most `DIRECTIONS`, none longer than `REACH` times the longest column.

    Examples
    --------
    >>> found = spaced_directions(np.diag([1.0, 1.0, 10.0]))
    >>> len(found.steps), float(found.lengths.max()) <= 25.0, round(float(found.weights.sum()), 12)
    (49, True, 1.0)
    """
    own = _own_frame(basis)
    longest = REACH * float(np.linalg.norm(own, axis=0).max()) * (1.0 + 1e-9)
    steps = np.unique([_nearest_step(own, target, longest) for target in _quasi_uniform(DIRECTIONS)], axis=0)
    return _weighted(own, steps, DEGREE)


def plain_directions(basis: FloatArray, count: int) -> LatticeDirections:
    """Return the 3 axes or all 13 neighbour directions with their Voronoi weights at this spacing.

    Examples
    --------
    >>> plain_directions(np.eye(3), 3).weights.round(6)
    array([0.333333, 0.333333, 0.333333])
    """
    return _weighted(_own_frame(basis), THIRTEEN[:count], 0)


def _own_frame(basis: FloatArray) -> FloatArray:
    """Return the lattice in a frame of its own (upper triangle, positive diagonal)."""
    upper = np.linalg.qr(basis)[1]
    return np.asarray(upper * np.sign(np.diag(upper))[:, None])


def _quasi_uniform(count: int) -> FloatArray:
    """Return (count, 3) unit vectors spread over half the sphere (Swinbank & Purser 2006)."""
    i = np.arange(count) + 0.5
    z = 1.0 - i / count
    angle = np.pi * (1.0 + np.sqrt(5.0)) * i
    ring = np.sqrt(1.0 - z * z)
    return np.column_stack([ring * np.cos(angle), ring * np.sin(angle), z])


def _nearest_step(basis: FloatArray, target: FloatArray, longest: float) -> IntArray:
    """Return the lattice vector nearest in direction to `target` among those up to `longest` mm."""
    along = np.linalg.solve(basis, target) * np.linspace(0.0, longest, _STEPS)[1:, None]
    corners = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), axis=-1).reshape(-1, 3)
    steps = np.unique((np.floor(along)[:, None] + corners).reshape(-1, 3).astype(np.int64), axis=0)
    steps = steps[np.gcd.reduce(steps, axis=1) == 1]
    vectors = steps @ basis.T
    lengths = np.linalg.norm(vectors, axis=1)
    fitting = lengths <= longest
    cosines = np.round((vectors[fitting] @ target) / lengths[fitting], 12)
    step: IntArray = steps[fitting][np.argmax(cosines)]
    first = step[np.flatnonzero(step)[-1]]
    return np.asarray(step * np.sign(first))


def _weighted(basis: FloatArray, steps: IntArray, degree: int) -> LatticeDirections:
    vectors = steps @ basis.T
    lengths = np.linalg.norm(vectors, axis=1)
    units = vectors / lengths[:, None]
    cells = SphericalVoronoi(np.concatenate([units, -units])).calculate_areas() / (4.0 * np.pi)
    weights = cells[: len(steps)] + cells[len(steps) :]
    return LatticeDirections(steps, lengths, _balanced(units, weights / weights.sum(), degree))


def _balanced(units: FloatArray, weights: FloatArray, degree: int) -> FloatArray:
    """Return the weights changed as little as possible so that even harmonics up to `degree` are exact.

    A degree that asks for more than the directions can give (or for negative weights) is lowered by 2.
    """
    for highest in range(degree, 0, -2):
        harmonics, exact = _even_monomials(units, highest)
        if 1.5 * len(harmonics) > len(units):
            continue
        gram = (harmonics * weights) @ harmonics.T
        change = np.linalg.lstsq(gram, exact - harmonics @ weights, rcond=1e-12)[0]
        balanced = weights * (1.0 + harmonics.T @ change)
        if balanced.min() > 0.0:
            return np.asarray(balanced / balanced.sum())
    return weights


def _even_monomials(units: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """Return the monomials of even `degree` at the directions, and their means over the sphere.

    On the sphere they span the even harmonics up to `degree`; the mean of x^a y^b z^c is
    (a-1)!!(b-1)!!(c-1)!!/(a+b+c+1)!! when all exponents are even, 0 otherwise (Folland 2001).
    """
    exponents = [(a, b, degree - a - b) for a in range(degree + 1) for b in range(degree + 1 - a)]
    values = np.array([np.prod(units ** np.array(e), axis=1) for e in exponents])
    means = [
        0.0
        if any(k % 2 for k in e)
        else np.prod([_odd_factorial(k - 1) for k in e]) / _odd_factorial(degree + 1)
        for e in exponents
    ]
    return values, np.array(means)


def _odd_factorial(n: int) -> float:
    """Return n!! for odd n ≥ -1."""
    return float(np.prod(np.arange(n, 0, -2))) if n > 0 else 1.0
