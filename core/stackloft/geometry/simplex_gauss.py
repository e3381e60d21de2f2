r"""Gauss rules on the unit triangle and the unit tetrahedron, degree 1 to 10, every weight positive.

::

        2
        | \           an orbit: one point and all that follow from it by renaming the corners, with one weight
        |  *\         degree d: every polynomial of total degree ≤ d is integrated exactly
        |*   \
        |   *  \
        0-------1

The rules are fully symmetric, of the orbits of Witherden & Vincent (2015), On the identification of symmetric
quadrature rules for finite element methods, Computers & Mathematics 69:1232: 1, 3, 6, 6, 7, 12, 15, 16, 19,
25 on the triangle (degree 4, 5, 6 and 8 also Dunavant 1985, IJNME 21:1129) and 1, 4, 8, 14, 14, 24, 35,
46, 59, 81 in the tetrahedron (degree 6 also Keast 1986, CMAME 55:339). Where a degree has no rule
of its own the next one serves. The digits were solved anew from the moment equations, to 30 digits.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.gauss_tetrahedron import TETRAHEDRON
from stackloft.geometry.gauss_triangle import TRIANGLE

FloatArray = NDArray[np.float64]

HIGHEST = 10
"""Highest degree that there is a rule for."""


@lru_cache
def simplex_gauss(dimension: int, degree: int) -> tuple[FloatArray, FloatArray]:
    """Return points (g, dimension) and weights (g,) on the unit simplex, exact to `degree`.

    Parameters
    ----------
    dimension : int
        2 (triangle, area ½) or 3 (tetrahedron, volume ⅙).
    degree : int
        1 to 10.

    Examples
    --------
    >>> x, w = simplex_gauss(2, 4)
    >>> len(w), bool(abs(w @ x[:, 0] ** 4 - 1 / 30) < 1e-16)
    (6, True)
    """
    rules = TRIANGLE if dimension == 2 else TETRAHEDRON
    orbits = rules[min(d for d in rules if d >= degree)]
    points, weights = [], []
    for weight, generator in orbits:
        orbit = sorted(set(permutations(generator)))
        points += orbit
        weights += [weight] * len(orbit)
    measure = 0.5 if dimension == 2 else 1.0 / 6.0
    return np.array(points)[:, 1:], measure * np.array(weights)
