"""How much area a skin between two loops needs at most, if it goes straight from one to the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.polygon_distance import inside_grid
from stackloft.geometry.shoelace import polygon_perimeter

FloatArray = NDArray[np.float64]

GRID = 128
"""Nodes along each side of the box in which the loops' difference is counted."""


def swept_area(low: FloatArray, high: FloatArray, gap: float) -> float:
    """Return the area between two loops seen along the axis, and the wall of their mean perimeter, mm².

    A skin that goes straight over has less: the root of the squares, piece by piece.

    Parameters
    ----------
    low, high : (k, 2) arrays
        Closed polygons, mm.
    gap : float
        Distance between their planes, mm.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    >>> round(swept_area(square, square + [1.0, 0.0], 2.0))
    40
    """
    both = np.concatenate([low, high])
    least, most = both.min(axis=0), both.max(axis=0)
    t = (np.arange(GRID) + 0.5) / GRID
    x, y = least[:, None] + t * (most - least)[:, None]
    one, two = (inside_grid(x, y, p, np.roll(p, -1, axis=0)) for p in (low, high))
    between = float((one != two).mean() * np.prod(most - least))
    return between + 0.5 * (polygon_perimeter(low) + polygon_perimeter(high)) * gap
