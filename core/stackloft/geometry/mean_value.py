r"""Inner points carried from one boundary to another: each stays the same mean of its neighbours.

::

       b                 w_j = (tan α_{j−1}/2 + tan α_j/2) / |p_j − p|, all positive; a point is the mean of
      /α\  c             its neighbours with weights w_j / Σw, so an affine map of the boundary maps every
     a--p--              point with it, and over a convex boundary no triangle can turn over

Floater (2003), Mean value coordinates, CAGD 20:19; Tutte (1963), How to draw a graph.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array, eye_array
from scipy.sparse.linalg import splu

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def carried(points: FloatArray, triangles: IntArray, boundary: int, rims: FloatArray) -> FloatArray:
    """Return all points for other boundaries.

    Parameters
    ----------
    points : (k, 2) array
        Where the points lie in the reference, those of the boundary first.
    triangles : (t, 3) int array
    boundary : int
        How many points the boundary has.
    rims : (layers, boundary, 3) array
        Other places of the boundary's points, mm.

    Returns
    -------
    (layers, k, 3) array

    Examples
    --------
    >>> square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]])
    >>> fan = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    >>> rim = np.column_stack([square[:4] * 4.0, np.full(4, 7.0)])
    >>> carried(square, fan, 4, rim[None])[0, 4].round(12).tolist()
    [2.0, 2.0, 7.0]
    """
    weights = _weights(points, triangles)
    inner = np.arange(boundary, len(points))
    share = csr_array(weights)[inner]
    matrix = csc_array(eye_array(len(inner)) - share[:, inner])
    flat = np.moveaxis(rims, 0, 1).reshape(boundary, -1)
    found = splu(matrix).solve(np.asarray(share[:, :boundary] @ flat))
    whole = np.concatenate([flat, found]).reshape(len(points), len(rims), 3)
    return np.asarray(np.moveaxis(whole, 1, 0))


def _weights(points: FloatArray, triangles: IntArray) -> csr_array:
    """Return each point's weights on its neighbours, rows summing to 1."""
    rows, columns, values = [], [], []
    for k in range(3):
        i, a, b = triangles[:, k], triangles[:, (k + 1) % 3], triangles[:, (k + 2) % 3]
        to_a, to_b = points[a] - points[i], points[b] - points[i]
        length_a, length_b = np.linalg.norm(to_a, axis=1), np.linalg.norm(to_b, axis=1)
        half = np.tan(0.5 * np.arccos(np.clip((to_a * to_b).sum(axis=1) / (length_a * length_b), -1.0, 1.0)))
        rows += [i, i]
        columns += [a, b]
        values += [half / length_a, half / length_b]
    count = len(points)
    raw = csr_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (count, count))
    total = np.asarray(raw.sum(axis=1)).ravel()
    return csr_array(raw.multiply(1.0 / total[:, None]))
