"""How far a posed body reaches along z."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.ndimage import maximum_filter

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.body import Patch
from stackloft.testing.phantoms.dual import Array

_GRID = (193, 97)
_STARTS = 6
_ROUNDS = 60


def sample(patch: Patch, shape: tuple[int, int] = _GRID) -> FloatArray:
    """Return the patch on a grid that includes its rectangle's border, (3, *shape) mm."""
    u = np.linspace(*patch.u, shape[0])
    v = np.linspace(*patch.v, shape[1])
    U, V = np.meshgrid(u, v, indexing="ij")
    return patch.surface(U.ravel(), V.ravel()).reshape(3, *shape)


def furthest(patch: Patch, direction: FloatArray) -> FloatArray:
    """Return the patch's point furthest along `direction`, (3) mm.

    Every local maximum of a grid is followed by a search on ever smaller 5 × 5 grids; the error in
    the reach is of the order of rounding, in the place of its square root.

    Examples
    --------
    >>> ball = Patch(lambda u, v: np.array([np.cos(u) * np.cos(v), np.cos(u) * np.sin(v), np.sin(u)]),
    ...              (-np.pi / 2, np.pi / 2), (0, 2 * np.pi))
    >>> tilted = np.array([0.6, 0.0, 0.8])
    >>> abs(float(tilted @ furthest(ball, tilted)) - 1) < 1e-14
    True
    """
    points = sample(patch)
    reach = np.tensordot(direction, points, axes=1)
    local = np.flatnonzero((reach == maximum_filter(reach, size=3, mode="nearest")).ravel())
    best = local[np.argsort(reach.ravel()[local])[::-1][:_STARTS]]
    rows, columns = np.unravel_index(best, reach.shape)
    u = np.linspace(*patch.u, reach.shape[0])[rows]
    v = np.linspace(*patch.v, reach.shape[1])[columns]
    steps = ((patch.u[1] - patch.u[0]) / _GRID[0], (patch.v[1] - patch.v[0]) / _GRID[1])
    found = _zoom(patch, lambda X: direction @ X, (u, v), steps)
    best_one: FloatArray = found[:, np.argmax(direction @ found)]
    return best_one


def _zoom(
    patch: Patch,
    reach: Callable[[Array], Array],
    start: tuple[FloatArray, FloatArray],
    steps: tuple[float, float],
) -> FloatArray:
    """Return for each start the best point found nearby, (3, starts)."""
    (u, v), (du, dv) = start, steps
    offsets = np.linspace(-1, 1, 5)
    shift_u, shift_v = (grid.ravel()[:, None] for grid in np.meshgrid(offsets, offsets, indexing="ij"))
    rows = np.arange(len(u))
    for _ in range(_ROUNDS):
        U = np.clip(u + du * shift_u, *patch.u)
        V = np.clip(v + dv * shift_v, *patch.v)
        values = reach(patch.surface(U.ravel(), V.ravel())).reshape(U.shape)
        pick = values.argmax(axis=0)
        u, v = U[pick, rows], V[pick, rows]
        du, dv = 0.6 * du, 0.6 * dv
    return patch.surface(u, v)
