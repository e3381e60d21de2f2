r"""Set covariance of a body on a lattice, and the boundary crossings along lattice lines that follow.

::

    K(h) = volume of (body ∩ body shifted by h)

      K(0) |\                 the slope at 0 along a direction is minus half the measure of all
           |  \               crossings of the boundary by lines of that direction
           |    \ .
           +-----+--+---- h
                 v  2v

Matheron (1967, 1975): −2 K'(0) = measure of crossings. On a smooth boundary K(h) = K(0) − N·h/2 + c·h³, for
lines that only graze the body are few; counting pairs of neighbours, as Crofton's formula is usually taken,
leaves c·h³ in place and errs low where h is long. With K(2h) it is removed (Richardson):

    N·h/2 = K(0) − K(h) + [K(0) − 2 K(h) + K(2h)] / 6
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


def set_covariance(mask: BoolArray, step: Sequence[int]) -> int:
    """Return how many voxels of a body have the voxel `step` away in the body too.

    Parameters
    ----------
    mask : bool array
        True in the body; outside the array there is none.
    step : sequence of int
        One shift per array axis.

    Examples
    --------
    >>> set_covariance(np.ones((4, 5, 6), bool), (1, -2, 0))
    54
    """
    here, there = [], []
    for size, shift in zip(mask.shape, step, strict=True):
        if abs(shift) >= size:
            return 0
        here.append(slice(max(shift, 0), size + min(shift, 0)))
        there.append(slice(max(-shift, 0), size + min(-shift, 0)))
    return int(np.count_nonzero(mask[tuple(here)] & mask[tuple(there)]))


def crossings(mask: BoolArray, step: Sequence[int], count: int) -> float:
    """Return the crossings of the boundary by all lattice lines along `step`, grazing lines made up for.

    Parameters
    ----------
    mask : bool array
        True in the body.
    step : sequence of int
        One shift per array axis, without a common factor.
    count : int
        Voxels of the body.

    Returns
    -------
    float
        Multiplied by the area per line it is the measure of crossings.

    Examples
    --------
    >>> bar = np.zeros((9, 9), bool)
    >>> bar[2:7, 1:8] = True
    >>> crossings(bar, (0, 1), 35)
    10.0
    """
    one = set_covariance(mask, step)
    two = set_covariance(mask, [2 * shift for shift in step])
    return 2.0 * (count - one) + (count - 2 * one + two) / 3.0
