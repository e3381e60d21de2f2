r"""Which of several equally good things is taken: never the one that happened to be numbered first.

::

       p .---. q        a ring's two shortest bridges are each other's mirror images; rounding and the vertex
        (  o  )         from which the ring was given would choose between them. Taken is the one that lies
       p'`---´ q'       farther to the right and up.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

EQUAL = 1e-6
"""Costs closer than this, in units of the body's size, differ by rounding, or by where vertices lie."""
TOWARDS = np.array([0.8, 0.6180339887498949])
"""A direction that is no body's axis of symmetry."""


def least_of(cost: FloatArray, ahead: FloatArray, size: float) -> int:
    """Return the number of the least cost; of those equal to it the one farthest ahead.

    Parameters
    ----------
    cost : (n,) array
    ahead : (n,) array
        How far each lies ahead, in any unit, as by `points_ahead` or `chords_ahead`.
    size : float
        Of the body, in the cost's unit.

    Examples
    --------
    >>> points = np.array([[0.0, 1.0], [3.0, 0.0], [-3.0, 0.0]])
    >>> least_of(np.array([2.0, 1.0 + 1e-15, 1.0]), points_ahead(points), 3.0)
    1
    """
    equal = np.flatnonzero(cost <= cost.min() + EQUAL * size)
    return int(equal[np.argmax(ahead[equal])])


def points_ahead(points: FloatArray) -> FloatArray:
    """Return how far ahead points lie, (n,) for (n, 2)."""
    return np.asarray(points @ TOWARDS)


def chords_ahead(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return how far ahead chords lie, (n,) for (n, 2) each, the same whichever end is called the start."""
    one, two = points_ahead(start), points_ahead(end)
    return np.asarray(np.maximum(one, two) + 0.1 * np.minimum(one, two))
