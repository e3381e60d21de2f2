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
    areas, sums = _loop_moments(loops, corner, [(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    mass = areas * weights
    centre = corner + (sums[1:] * weights).sum(axis=1) / mass.sum()
    height = z - float((mass * z).sum() / mass.sum())
    _, spread = _loop_moments(loops, centre, [(2, 0, 0), (0, 2, 0)])
    radius = np.sqrt((spread.sum(axis=0) * weights).sum() / mass.sum())
    tall = np.sqrt((mass * height**2).sum() / mass.sum()) or 1.0
    _, wanted = _loop_moments(loops, centre, powers)
    orders = np.array(powers)
    along = np.power(height[None, :], orders[:, 2:])
    size = mass.sum() * radius ** orders[:, :2].sum(axis=1) * tall ** orders[:, 2]
    return np.asarray((wanted * along * weights).sum(axis=1) / size)


def _loop_moments(
    loops: list[FloatArray], centre: FloatArray, powers: list[Powers]
) -> tuple[FloatArray, FloatArray]:
    """Return each loop's area, (n,), and its moments about a centre, (len(powers), n), by Green's theorem."""
    first = np.cumsum([0, *(len(p) for p in loops[:-1])])
    start = np.concatenate(loops) - centre
    end = np.concatenate([np.roll(p, -1, axis=0) for p in loops]) - centre
    rise = end - start
    x, y = (start[:, k] + _GAUSS_T[:, None] * rise[:, k] for k in (0, 1))
    signed = np.add.reduceat(_GAUSS_W @ x * rise[:, 1], first)
    found = [
        np.add.reduceat(_GAUSS_W @ (x ** (p + 1) * y**q) * rise[:, 1], first) / (p + 1) for p, q, _ in powers
    ]
    return np.abs(signed), np.sign(signed) * np.array(found)
