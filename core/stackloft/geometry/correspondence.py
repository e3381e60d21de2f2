"""Which point of one section belongs to which point of the next.

Equal fractions of arc length drift along the surface where a section turns concave, and the drift adds
false area. Here the points of all sections slide along their curves until the columns they form are as
short as possible without bunching:

    E = ∫∫ |∂Q/∂z|² dz dt  +  λ ∫∫ (∂s/∂t / w − 1)² dz dt

Q is the point relative to its section's centroid, s the fraction of arc length, w the even spacing. Both
terms are integrals, so the answer does not depend on how many sections there are. Solved by damped
Gauss-Newton; the matrix is banded (points first, sections second).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from stackloft.compiled.ring_chain import solve_rings
from stackloft.compiled.slide_system import slide_system
from stackloft.geometry.curve_stack import CurveStack

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

EVENNESS = 10.0
"""λ: what uneven spacing costs against the slope of the columns."""
HOLD = 0.3
"""Pull to the first guess, which keeps all columns from sliding round together."""
HUGE = 1e12
"""Of the largest coefficient, those of points that stay."""
ITERATIONS = 4
LEAST_SHARE = 0.25
"""Sections that lie close together count for spacing as if this fraction of the mean pitch apart, lest
their points bunch."""


def slide_points(curves: CurveStack, z: FloatArray, s: FloatArray, fixed: BoolArray) -> FloatArray:
    """Return fractions of arc length whose points form the shortest even columns.

    Parameters
    ----------
    curves : CurveStack
        m closed curves.
    z : (m,) array
        Positions, mm.
    s : (m, N) array
        First guess, increasing along each row over less than one turn.
    fixed : (m, N) bool array
        Points that stay (corners).

    Returns
    -------
    (m, N) array
        Increasing along each row.
    """
    if len(s) < 2:
        return s
    section = np.arange(len(s))[:, None]
    spacing = _gaps(s)
    weights = _weights(z)
    current = s
    for _ in range(ITERATIONS):
        point, slope = curves.at(section, current)
        point = point - curves.centroids[:, None, :]
        step = _newton_step((point, slope), (current, s, spacing), weights, fixed)
        largest = np.abs(step / spacing).max()
        current = _in_order(current, step, spacing)
        if largest < 5e-3:
            break
    return current


def _weights(z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return 1/h of each pair and each section's share of the length, not less than `LEAST_SHARE`."""
    gap = np.diff(z)
    share = np.zeros(len(z))
    share[:-1] += 0.5 * gap
    share[1:] += 0.5 * gap
    return 1.0 / gap, np.maximum(share, LEAST_SHARE * share.mean())


def _gaps(s: FloatArray) -> FloatArray:
    """Return s[j + 1] - s[j] round the loop, (m, N)."""
    return np.mod(np.concatenate([s[:, 1:], s[:, :1]], axis=1) - s, 1.0)


def _before(s: FloatArray) -> FloatArray:
    """Return s[j - 1] round the loop, (m, N)."""
    return np.concatenate([s[:, -1:], s[:, :-1]], axis=1)


def _dots(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the scalar products of vectors, (m, N) of (m, N, 2)."""
    product: FloatArray = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
    return product


def _newton_step(
    on_curves: tuple[FloatArray, FloatArray],
    fractions: tuple[FloatArray, FloatArray, FloatArray],
    weights: tuple[FloatArray, FloatArray],
    fixed: BoolArray,
) -> FloatArray:
    """Return the Gauss-Newton step of E for all points, (m, N)."""
    system = slide_system(on_curves, fractions, weights, (EVENNESS, HOLD), (fixed, HUGE))
    if system is None:
        system = _system(on_curves, fractions, weights, fixed)
    step = solve_rings(*system)
    return -(_solved(*system) if step is None else step)


def _system(
    on_curves: tuple[FloatArray, FloatArray],
    fractions: tuple[FloatArray, FloatArray, FloatArray],
    weights: tuple[FloatArray, FloatArray],
    fixed: BoolArray,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return what `slide_system` does, all points at once."""
    (point, slope), (current, first, spacing), (weight_pair, weight_own) = on_curves, fractions, weights
    pair = weight_pair[:, None]
    # evenness: residual gap / spacing - 1; a pull to the first guess
    share = weight_own[:, None] / spacing**2
    stiff = EVENNESS * share
    stretch = stiff * (_gaps(current) - spacing)
    diagonal = stiff + _before(stiff) + HOLD * share
    gradient = _before(stretch) - stretch + HOLD * share * (current - first)
    # columns: residual Q[i+1] - Q[i]
    rise = point[1:] - point[:-1]
    squared = _dots(slope, slope)
    diagonal[1:] += pair * squared[1:]
    diagonal[:-1] += pair * squared[:-1]
    gradient[1:] += pair * _dots(rise, slope[1:])
    gradient[:-1] -= pair * _dots(rise, slope[:-1])
    across = np.zeros(current.shape)
    across[:-1] = -pair * _dots(slope[1:], slope[:-1])
    diagonal[fixed] += HUGE * diagonal.max()
    gradient[fixed] = 0.0
    return diagonal, -stiff, across, gradient


def _solved(diagonal: FloatArray, along: FloatArray, across: FloatArray, right: FloatArray) -> FloatArray:
    """Return what `solve_rings` does, by LAPACK."""
    m, n = diagonal.shape
    bands = np.zeros((m * n, n + 1)).T  # as LAPACK wants it, so that nothing is copied
    bands[0] = diagonal.ravel()
    beside = np.zeros((2, m, n))
    beside[0, :, :-1], beside[1, :, 0] = along[:, :-1], along[:, -1]
    bands[1], bands[n - 1] = beside.reshape(2, -1)
    bands[n] = across.ravel()
    solved = solveh_banded(bands, right.ravel(), overwrite_ab=True, lower=True, check_finite=False)
    return np.asarray(solved).reshape(m, n)


def _in_order(current: FloatArray, step: FloatArray, spacing: FloatArray) -> FloatArray:
    """Return current + step, shortened where points would pass each other or bunch."""
    for _ in range(12):
        trial = current + step
        gap = np.concatenate([trial[:, 1:], trial[:, :1] + 1.0], axis=1) - trial
        if (gap > 0.2 * spacing).all():
            return trial
        step = 0.5 * step
    return current
