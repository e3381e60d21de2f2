r"""Moments of a stack that change their sign in a mirror: which way round a body lies.

::

     y|  .--.               ∫ x³: the long tail lies to the right; of the mirror image it is as much,
      | (    `-----.        with the other sign. ∫ x y changes its sign in either mirror, ∫ x z in that
      |  `--´-----´ x       of x alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Powers = tuple[int, int, int]

_GAUSS_T, _GAUSS_W = np.polynomial.legendre.leggauss(3)
_GAUSS_T, _GAUSS_W = 0.5 * (_GAUSS_T + 1.0), 0.5 * _GAUSS_W
HIGHEST = 4
"""Degree in x and y to which three Gauss points per side are exact."""


def central_moment_ratios(
    loops: list[FloatArray], z: FloatArray, weights: FloatArray, powers: list[Powers]
) -> FloatArray:
    """Return moments Σ w z^r ∫∫ x^p y^q dA about the loops' common centre, each in units of its size.

    Parameters
    ----------
    loops : list of (k, 2) arrays
        Polygons, mm; each counts as positive area, whichever way it runs and whatever it bounds.
    z : (n,) array
        The loops' positions, mm.
    weights : (n,) array
        What each loop counts for, mm along the axis.
    powers : list of (p, q, r)
        p + q at most `HIGHEST`.

    Returns
    -------
    (len(powers),) array
        Divided by Σ w A · R^(p + q) · H^r, with the radii of gyration R in the plane and H along the axis:
        about 1 where a body is as lopsided as can be, about 1e-16 where it is symmetric.

    Examples
    --------
    >>> wedge = np.array([[0.0, 0.0], [6.0, -1.0], [6.0, 1.0]])
    >>> args = (np.zeros(1), np.ones(1), [(3, 0, 0), (0, 3, 0), (1, 1, 0)])
    >>> (central_moment_ratios([wedge], *args).round(3) + 0.0).tolist()
    [-0.502, 0.0, 0.0]
    >>> (central_moment_ratios([wedge * [-1, 1]], *args).round(3) + 0.0).tolist()
    [0.502, 0.0, 0.0]
    """
    corner = loops[0].mean(axis=0)
    areas, arms = _areas_and_arms(loops, corner)
    mass = areas * weights
    centre = corner + (arms * weights).sum(axis=1) / mass.sum()
    height = z - float((mass * z).sum() / mass.sum())
    moments = _loop_moments(loops, centre, [(2, 0, 0), (0, 2, 0), *powers])
    radius = np.sqrt((moments[:2].sum(axis=0) * weights).sum() / mass.sum())
    tall = np.sqrt((mass * height**2).sum() / mass.sum()) or 1.0
    orders = np.array(powers)
    along = np.power(height[None, :], orders[:, 2:])
    size = mass.sum() * radius ** orders[:, :2].sum(axis=1) * tall ** orders[:, 2]
    return np.asarray((moments[2:] * along * weights).sum(axis=1) / size)


def _areas_and_arms(loops: list[FloatArray], corner: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return each loop's area, (n,), and its first moments in x and y about a point, (2, n)."""
    found = np.empty((3, len(loops)))
    for k, loop in enumerate(loops):
        x, y = loop.T - corner[:, None]
        cross = x[:-1] * y[1:] - x[1:] * y[:-1]
        last = x[-1] * y[0] - x[0] * y[-1]
        found[0, k] = 0.5 * (cross.sum() + last)
        for each, value in ((x, 1), (y, 2)):
            found[value, k] = (cross @ (each[:-1] + each[1:]) + last * (each[-1] + each[0])) / 6.0
    return np.abs(found[0]), np.sign(found[0]) * found[1:]


def _loop_moments(loops: list[FloatArray], centre: FloatArray, powers: list[Powers]) -> FloatArray:
    """Return each loop's moments about a centre, (len(powers), n), by Green's theorem, its area positive."""
    orders = np.array(powers)
    found = np.empty((len(powers), len(loops)))
    for k, loop in enumerate(loops):
        start = np.ascontiguousarray(loop.T) - centre[:, None]
        rise = np.concatenate([start[:, 1:], start[:, :1]], axis=1) - start
        x, y = (start[:, None] + _GAUSS_T[:, None] * rise[:, None]).reshape(2, -1)
        across, up = _powers(x, int(orders[:, 0].max()) + 1), _powers(y, int(orders[:, 1].max()))
        every = across @ ((_GAUSS_W[:, None] * rise[1]).ravel() * up).T  # of every x^p y^q at once
        found[:, k] = np.sign(every[1, 0]) * every[orders[:, 0] + 1, orders[:, 1]] / (orders[:, 0] + 1)
    return found


def _powers(x: FloatArray, highest: int) -> FloatArray:
    """Return 1, x, x² … as rows."""
    rows = np.empty((highest + 1, len(x)))
    rows[0] = 1.0
    for k in range(highest):
        np.multiply(rows[k], x, out=rows[k + 1])
    return rows
