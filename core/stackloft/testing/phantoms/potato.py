"""A bumpy, smooth, star-shaped body: r(d) = R·(1 + Σ a_lm·Y_lm(d)) with seeded coefficients."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.body import Body
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.star_body import star_body


def potato(
    radius: float = 30.0, bumps: float = 0.05, degree: int = 5, seed: int = 1, elongation: float = 1.3
) -> Body:
    """Return a seeded potato.

    Bumps of degree l = 2…`degree` have a power that falls as l⁻⁴ and together the root mean square
    `bumps` (relative to the radius); the body is then made `elongation` times longer along z.

    Parameters
    ----------
    radius : float
        Mean radius before the stretch, mm.
    bumps : float
        0 to 0.15.
    degree : int
        2 to 12.
    seed : int
        Another seed, another potato.
    elongation : float
        0.5 to 2.

    Examples
    --------
    >>> potato(seed=1).volume == potato(seed=1).volume != potato(seed=2).volume
    True
    """
    positive(radius=radius)
    within(0, 0.15, bumps=bumps)
    within(2, 12, degree=degree)
    within(0.5, 2, elongation=elongation)
    coefficients = _coefficients(bumps, degree, seed)

    def distance(d: Array) -> Array:
        relief: Array = np.ones_like(d[0])
        for c, y in zip(coefficients, harmonics(d, degree), strict=True):
            relief = relief + np.einsum("k,kn->n", c, y)
        return radius * relief

    return star_body(
        distance,
        np.array([1.0, 1.0, elongation]),
        {"radius": radius, "bumps": bumps, "degree": degree, "seed": seed, "elongation": elongation},
    )


def _coefficients(bumps: float, degree: int, seed: int) -> Sequence[FloatArray]:
    """Return coefficients per degree, (2l + 1) each; degrees 0 and 1 are zero (size and place)."""
    rng = np.random.default_rng(seed)
    drawn = [
        rng.normal(size=2 * ell + 1) / ell**2.5 if ell >= 2 else np.zeros(2 * ell + 1)
        for ell in range(degree + 1)
    ]
    power = sum(float(c @ c) for c in drawn) / (4 * np.pi)
    return [c * bumps / math.sqrt(power) for c in drawn]


def harmonics(d: Array, degree: int) -> list[Array]:
    """Return the real orthonormal spherical harmonics of unit vectors (3, n), degree by degree.

    Entry l is (2l + 1, n), orders −l…l. Computed as polynomials in the components (no angles), so that
    there is no pole and the complex step passes through.

    Examples
    --------
    >>> up = np.array([[0.0], [0.0], [1.0]])
    >>> y = harmonics(up, 1)
    >>> round(float(y[1][1, 0] ** 2 * 4 * np.pi), 12)  # Y_10² = 3/(4π) at the pole
    3.0
    """
    cosines, sines = [np.ones_like(d[0])], [np.zeros_like(d[0])]
    for _ in range(degree):
        c, s = cosines[-1], sines[-1]
        cosines.append(d[0] * c - d[1] * s)
        sines.append(d[0] * s + d[1] * c)
    legendre = _legendre(d[2], degree)
    result = []
    for ell in range(degree + 1):
        rows = [math.sqrt(2) * _norm(ell, m) * legendre[ell, m] * sines[m] for m in range(ell, 0, -1)]
        rows.append(_norm(ell, 0) * legendre[ell, 0])
        rows += [math.sqrt(2) * _norm(ell, m) * legendre[ell, m] * cosines[m] for m in range(1, ell + 1)]
        result.append(np.stack(rows))
    return result


def _norm(ell: int, m: int) -> float:
    return math.sqrt((2 * ell + 1) / (4 * math.pi) * math.factorial(ell - m) / math.factorial(ell + m))


def _legendre(z: Array, degree: int) -> dict[tuple[int, int], Array]:
    """Return d^m P_l/dz^m: the associated Legendre functions less their factor (1 − z²)^(m/2)."""
    table: dict[tuple[int, int], Array] = {}
    for m in range(degree + 1):
        table[m, m] = np.full_like(z, math.prod(range(1, 2 * m, 2)))
        if m < degree:
            table[m + 1, m] = (2 * m + 1) * z * table[m, m]
        for ell in range(m + 2, degree + 1):
            table[ell, m] = ((2 * ell - 1) * z * table[ell - 1, m] - (ell + m - 1) * table[ell - 2, m]) / (
                ell - m
            )
    return table
