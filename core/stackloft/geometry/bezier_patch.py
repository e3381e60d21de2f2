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
    planes = patch_planes(patches)
    lead = planes.shape[3:]
    inner = along_v @ planes.reshape(4, -1)
    outer = np.matmul(along_u, inner.reshape(len(along_v), 4, -1))  # (a, b, 3 · patches)
    found = outer.reshape(len(along_v), len(along_u), 3, *lead)
    return np.asarray(found.transpose(*range(len(lead) + 2, 2, -1), 0, 1, 2))


def patch_planes(patches: FloatArray) -> FloatArray:
    """Return (..., 4, 4, 3) patches as (4, 4, 3, ...), leading axes turned over: as a skin lies in memory.

    Examples
    --------
    >>> patch_planes(np.zeros((7, 5, 4, 4, 3))).shape
    (4, 4, 3, 5, 7)
    """
    lead = patches.ndim - 3
    return patches.transpose(lead, lead + 1, lead + 2, *range(lead - 1, -1, -1))
