r"""A tube of bicubic patches as rings of points and triangles between them, to a tolerance.

::

    +--+--+     rows of quadrilaterals, each split
    |\ |\ |     along its shorter diagonal
    +--+--+
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.bezier_patch import bernstein

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

FINEST = 64
"""Most subdivisions of one patch in one direction."""


def ring_grid(patches: FloatArray, tolerance: float, rings: int = 2) -> FloatArray:
    """Return rings of points on a tube, close enough for triangles within `tolerance` of the patches.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array
        Bézier control points [v, u], mm.
    tolerance : float
        Largest wanted distance between triangles and surface, mm.
    rings : int
        Least number of rings.

    Returns
    -------
    (rings, around, 3) array, mm
        From the first row to the last; rings close on themselves.
    """
    along_v, along_u = _subdivisions(patches, tolerance)
    along_v[0] = max(along_v[0], rings - len(patches))
    return _grid(patches, along_v, along_u)


def _subdivisions(patches: FloatArray, tolerance: float) -> tuple[IntArray, IntArray]:
    """Return how often to cut each row and each column so that chords and twist stay within the tolerance.

    A cubic strays from a chord over 1/n of it by at most 6·max|Δ²b|/(8n²); a patch's twist adds at most
    9·max|Δu Δv b|/(4 n_u n_v).
    """
    bend_v = np.linalg.norm(np.diff(patches, 2, axis=-3), axis=-1).max(axis=(1, 2, 3))
    bend_u = np.linalg.norm(np.diff(patches, 2, axis=-2), axis=-1).max(axis=(0, 2, 3))
    twist = np.linalg.norm(np.diff(np.diff(patches, axis=-3), axis=-2), axis=-1).max(axis=(2, 3))
    share = tolerance / 3.0
    n_v = np.maximum(np.sqrt(0.75 * bend_v / share), 1.0)
    n_u = np.maximum(np.sqrt(0.75 * bend_u / share), 1.0)
    lack = np.sqrt(2.25 * twist / (share * n_v[:, None] * n_u))  # shared between both directions
    n_v, n_u = n_v * np.maximum(lack.max(axis=1), 1.0), n_u * np.maximum(lack.max(axis=0), 1.0)
    return _counts(n_v), _counts(n_u)


def _counts(ideal: FloatArray) -> IntArray:
    return np.clip(np.ceil(ideal), 1, FINEST).astype(np.int64)


def _grid(patches: FloatArray, n_v: IntArray, n_u: IntArray) -> FloatArray:
    """Return points (Σ n_v + 1, Σ n_u, 3) on the surface; columns close on themselves."""
    rings = [_ring_rows(patches[row], np.arange(n) / n, n_u) for row, n in enumerate(n_v)]
    return np.concatenate([*rings, _ring_rows(patches[-1], np.ones(1), n_u)])


def _ring_rows(row: FloatArray, v: FloatArray, n_u: IntArray) -> FloatArray:
    """Return points (len(v), Σ n_u, 3) of one row of patches (columns, 4, 4, 3)."""
    column = np.repeat(np.arange(len(n_u)), n_u)
    u = np.concatenate([np.arange(n) / n for n in n_u])
    across = np.einsum("ak,cklx->aclx", bernstein(v), row)
    return np.asarray(np.einsum("aplx,pl->apx", across[:, column], bernstein(u)))


def quads(points: FloatArray, index: IntArray) -> IntArray:
    """Return two triangles per quadrilateral of a grid of rings, split along the shorter diagonal.

    Parameters
    ----------
    points : (n, 3) array, mm
    index : (rings, around) int array
        Point numbers; rings close on themselves.
    """
    a, b = index[:-1].ravel(), np.roll(index[:-1], -1, axis=1).ravel()
    d, c = index[1:].ravel(), np.roll(index[1:], -1, axis=1).ravel()
    straight = np.linalg.norm(points[a] - points[c], axis=1) <= np.linalg.norm(points[b] - points[d], axis=1)
    one = np.where(straight[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    two = np.where(straight[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.concatenate([one, two])
