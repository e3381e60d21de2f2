r"""The largest disc that touches a closed curve at a point from one side and holds no other point of it.

::

        .-------.          a disc through p with its centre on the normal passes through q when
       /    o    \         its radius is |q − p|² / (2·n·(q − p)); the least over all q touches
      (     |n    )        and holds nobody (the medial axis' disc at p)
       \    p    /
        `-------´
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def tangent_disc_curvatures(points: FloatArray, normals: FloatArray, near: float) -> FloatArray:
    """Return 1/radius of the largest empty disc at every point, on the side that the normals point to.

    Parameters
    ----------
    points : (n, 2) array
        Points along closed curves, mm.
    normals : (n, 2) array
        Unit normals, into the side in question.
    near : float
        mm; points of the same run of curve (normals less than 60° apart) that lie nearer are left out, since
        noise there would pass for curvature.

    Returns
    -------
    (n,) array
        1/mm, 0 where no disc is too large (outside a convex curve).

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(60) / 60
    >>> n = -np.column_stack([np.cos(t), np.sin(t)])
    >>> k = tangent_disc_curvatures(-4 * n, n, 1.0)
    >>> bool(np.allclose(k, 0.25)), tangent_disc_curvatures(-4 * n, -n, 1.0).max().tolist()
    (True, 0.0)
    """
    apart = points[None, :, :] - points[:, None, :]
    squared = (apart**2).sum(axis=2)
    along = np.einsum("pk,pqk->pq", normals, apart)
    beside = (squared < near**2) & (normals @ normals.T > 0.5)
    curvature = np.where(beside, 0.0, 2.0 * along / np.where(squared > 0.0, squared, 1.0))
    return np.asarray(np.maximum(curvature.max(axis=1), 0.0))
