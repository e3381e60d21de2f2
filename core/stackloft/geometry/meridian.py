r"""The mean meridian: radius of the circle of equal area against position, and its arc length.

::

      r = √(A/π)      .---.          arc length t runs along the curve, so that a round end, where
                    /       \        r goes as the square root of the depth, is as smooth in t as
                   |         |       the body's middle
        z ------ pole ----- pole
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

FloatArray = NDArray[np.float64]

_REFINEMENTS = 3
_GAUSS_X, _GAUSS_W = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True, slots=True, eq=False)
class Meridian:
    """Position as a function of arc length."""

    nodes: FloatArray
    """(k,) arc length at the given rows, from 0, mm."""
    _z: CubicSpline

    def z(self, t: FloatArray) -> FloatArray:
        """Return positions at arc lengths, mm; never beyond the first and last row."""
        ends = self._z(self.nodes[[0, -1]])
        return np.asarray(np.clip(self._z(np.clip(t, 0.0, self.nodes[-1])), *ends))


def mean_meridian(z: FloatArray, radii: FloatArray, smooth: tuple[bool, bool]) -> Meridian:
    """Return the meridian through rows.

    Parameters
    ----------
    z : (k,) array
        Positions, mm, increasing, k ≥ 2.
    radii : (k,) array
        Radii of the circles of equal area, mm; 0 at a pole.
    smooth : pair of bool
        True where the first (last) row is a round pole: the meridian meets the axis at a right angle.

    Examples
    --------
    A ball of radius 3 from pole to pole is half a circle of length 3π:

    >>> z = 3 * np.sin(np.linspace(-np.pi / 2, np.pi / 2, 9))
    >>> half = mean_meridian(z, np.sqrt(9 - z**2), (True, True))
    >>> bool(abs(half.nodes[-1] / (3 * np.pi) - 1) < 1e-3)
    True
    """
    points = np.column_stack([z, radii])
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    inward = np.array([0.0, 1.0])
    tangents = (inward if smooth[0] else None, -inward if smooth[1] else None)
    for _ in range(_REFINEMENTS):
        nodes = np.concatenate([[0.0], np.cumsum(step)])
        curve = cubic_across(nodes, points, tangents)
        within = nodes[:-1, None] + 0.5 * np.diff(nodes)[:, None] * (_GAUSS_X + 1.0)
        speed = np.linalg.norm(curve(within, 1), axis=-1)
        step = 0.5 * np.diff(nodes) * (speed @ _GAUSS_W)
    nodes = np.concatenate([[0.0], np.cumsum(step)])
    level = np.zeros(())
    return Meridian(
        nodes, cubic_across(nodes, z, (level if smooth[0] else None, level if smooth[1] else None))
    )


def cubic_across(
    nodes: FloatArray, values: FloatArray, slopes: tuple[FloatArray | None, FloatArray | None]
) -> CubicSpline:
    """Return the cubic spline through rows of values; a free end gets the neighbouring cubic continued.

    Parameters
    ----------
    nodes : (k,) array
        Increasing, k ≥ 2.
    values : (k, ...) array
    slopes : pair of (...) arrays or None
        Derivative at the first (last) node; None: free. With fewer than 4 rows a free end does not bend.

    Examples
    --------
    >>> t = np.linspace(0.0, 1.0, 5)
    >>> float(cubic_across(t, t**3, (None, np.array(3.0)))(0.3).round(12))
    0.027
    """
    free: Any = "not-a-knot" if len(nodes) >= 4 else (2, np.zeros(values.shape[1:]))
    ends: Any = tuple(free if slope is None else (1, slope) for slope in slopes)
    return CubicSpline(nodes, values, axis=0, bc_type=ends)
