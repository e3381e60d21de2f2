r"""A displacement in a path that is otherwise smooth: from one place on, or of one point alone.

::

           *   *                     *
    *  *     ------>   step               ------>  single
             *  *   *        *   *       *  *

The displacement is the one that leaves the least third differences, by least squares.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.roughness import FEWEST, NOISE, third_differences

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Displacement:
    """The one displacement that makes a path smoothest."""

    first: int
    """Number of the first displaced point."""
    single: bool
    """True when that point alone is displaced; False when all that follow are."""
    shift: tuple[float, float]
    """Whereto, in the path's unit."""
    gain: float
    """Roughness as given by roughness without it, both with the noise's own added."""

    @property
    def length(self) -> float:
        """In the path's unit."""
        return float(np.hypot(*self.shift))


def best_displacement(position: FloatArray, path: FloatArray, noise: float) -> Displacement | None:
    """Return the displacement whose taking back smooths the path most; None for too few points.

    Parameters
    ----------
    position : array (m), increasing
    path : array (m, 2)
    noise : float
        Standard deviation of a point in the path.

    Examples
    --------
    >>> z = np.arange(12.0)
    >>> path = np.column_stack([0.1 * z**2, 3 - z])
    >>> path[7:] += [3.0, 4.0]
    >>> found = best_displacement(z, path, 0.01)
    >>> found.first, found.single, round(found.length, 6)
    (7, False, 5.0)
    """
    m = len(position)
    if m < FEWEST + 1:
        return None
    given = third_differences(position, path)
    found = []
    for k in range(1, m):
        for single in (False, True):
            mark = np.zeros((m, 1))
            mark[k : k + 1 if single else m] = 1.0
            shape = third_differences(position, mark)
            total = float((shape**2).sum())
            shift = (shape * given).sum(axis=0) / total
            left = given - shape * shift
            gain = (_variance(given) + noise**2) / (_variance(left) + noise**2)
            found.append(Displacement(k, single, (float(shift[0]), float(shift[1])), gain))
    return max(found, key=lambda one: one.gain)


def _variance(differences: FloatArray) -> float:
    return float((differences**2).sum(axis=1).mean()) / NOISE**2
