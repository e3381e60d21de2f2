r"""Bicubic Bézier patches: from Hermite data, evaluated and differentiated on grids.

::

    v=1  30---31---32---33
          |    |    |    |        control[v, u]
         20---21---22---23        u along the loop, v across sections
          |    |    |    |        outward normal = P_u × P_v for counter-clockwise
         10---11---12---13        loops and v along +z
          |    |    |    |
    v=0  00---01---02---03
        u=0             u=1
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

HERMITE_TO_BEZIER = np.array(
    [[1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 1.0 / 3.0, 0.0], [0.0, 1.0, 0.0, -1.0 / 3.0], [0.0, 1.0, 0.0, 0.0]]
)
"""Bézier points of a cubic from (value 0, value 1, slope 0, slope 1) on the unit interval."""


def bernstein(x: FloatArray) -> FloatArray:
    """Return the four cubic Bernstein polynomials at x, (g, 4) for (g,) x.

    Examples
    --------
    >>> bernstein(np.array([0.5])).tolist()
    [[0.125, 0.375, 0.375, 0.125]]
    """
    y = 1.0 - x
    return np.stack([y**3, 3.0 * x * y**2, 3.0 * x**2 * y, x**3], axis=-1)


def bernstein_slope(x: FloatArray) -> FloatArray:
    """Return the derivatives of the four cubic Bernstein polynomials at x, (g, 4)."""
    y = 1.0 - x
    return np.stack([-3.0 * y**2, 3.0 * y**2 - 6.0 * x * y, 6.0 * x * y - 3.0 * x**2, 3.0 * x**2], axis=-1)


def evaluate(patches: FloatArray, along_v: FloatArray, along_u: FloatArray) -> FloatArray:
    """Return Σ along_v[a, k] control[k, l] along_u[b, l] for every patch.

    Parameters
    ----------
    patches : (..., 4, 4, 3) array
        Control points [v, u], mm.
    along_v, along_u : (a, 4), (b, 4) arrays
        Bernstein values (or slopes) at the wanted parameters.

    Returns
    -------
    (..., a, b, 3) array
    """
    inner = np.matmul(along_u, patches)  # (..., 4, b, 3)
    lead = inner.shape[:-3]
    b = len(along_u)
    flat = np.matmul(along_v, inner.reshape(*lead, 4, b * 3))
    return np.asarray(flat.reshape(*lead, len(along_v), b, 3))
