"""Volume and area of a boundary given by patches, by quadrature of its own parametrisation.

V = ⅓ ∮ X·(X_u × X_v) du dv (divergence theorem), S = ∮ |X_u × X_v| du dv. The rules are refined
until two successive ones agree to `TOLERANCE`, so that a figure is known to 1e-9 with room to spare.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.body import Patch, Rule
from stackloft.testing.phantoms.dual import STEP

TOLERANCE = 2e-12
_LARGEST = 1100
_PANELS = 8


def nodes_and_weights(rule: Rule, count: int, interval: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Return about `count` nodes and weights on `interval`.

    ``gauss`` is Gauss–Legendre on eight panels (a waist or a dimple takes up one or two), ``periodic`` the
    trapezoidal rule (spectral for closed smooth curves), ``graded`` the tanh-sinh rule (Takahasi & Mori
    1974), spectral for ends like t^q, q > −1.

    Examples
    --------
    >>> t, w = nodes_and_weights("graded", 60, (0.0, 1.0))
    >>> abs(float(w @ np.sqrt(t)) - 2 / 3) < 1e-12
    True
    """
    low, high = interval
    if rule == "periodic":
        w = np.full(count, (high - low) / count)
        return low + (high - low) * np.arange(count) / count, w
    if rule == "gauss":
        t, w = np.polynomial.legendre.leggauss(max(3, count // _PANELS))
        panel = (high - low) / _PANELS
        starts = low + panel * np.arange(_PANELS)[:, None]
        return (starts + panel * (t + 1) / 2).ravel(), np.tile(w * panel / 2, _PANELS)
    k = np.linspace(-3.2, 3.2, count)
    s = np.pi / 2 * np.sinh(k)
    t = 1 / (1 + np.exp(-2 * s))
    w = (k[1] - k[0]) * np.pi / 4 * np.cosh(k) / np.cosh(s) ** 2
    return low + (high - low) * t, w * (high - low)


def patch_figures(patch: Patch, count: int) -> tuple[float, float]:
    """Return the patch's part of the volume (mm³) and its area (mm²) with `count`² nodes."""
    u, wu = nodes_and_weights(patch.rules[0], count, patch.u)
    v, wv = nodes_and_weights(patch.rules[1], count, patch.v)
    U, V = (grid.ravel() for grid in np.meshgrid(u, v, indexing="ij"))
    weights = np.outer(wu, wv).ravel()
    along_u = patch.surface(U + 1j * STEP, V.astype(complex))
    along_v = patch.surface(U.astype(complex), V + 1j * STEP)
    normal = np.cross(along_u.imag / STEP, along_v.imag / STEP, axis=0)
    flux = np.einsum("in,in->n", along_u.real, normal)
    return float(weights @ flux) / 3, float(weights @ np.linalg.norm(normal, axis=0))


def figures(patches: Sequence[Patch]) -> tuple[float, float]:
    """Return volume (mm³) and area (mm²) of the closed boundary that `patches` make up.

    Raises
    ------
    ArithmeticError
        The rules did not settle to `TOLERANCE`: the patches are not smooth on their rectangles.
    """
    count = 24
    before = change = np.full(2, np.inf)
    while count <= _LARGEST:
        now = np.sum([patch_figures(patch, count) for patch in patches], axis=0)
        change = np.abs(now - before) / np.abs(now)
        if (change <= TOLERANCE).all():
            return float(now[0]), float(now[1])
        before, count = now, count + count // 2
    message = f"volume and area did not settle: last change {change}"
    raise ArithmeticError(message)
