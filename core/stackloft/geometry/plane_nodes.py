"""Nodes of a plane grid that a mirrored body gets mirrored."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def centred_nodes(
    low: FloatArray, high: FloatArray, step: float, margin: int
) -> tuple[FloatArray, FloatArray]:
    """Return the coordinates along x and y of a grid that lies evenly about the middle of a box.

    Parameters
    ----------
    low, high : (2,) arrays
        The box's corners, mm.
    step : float
        Side of a cell, mm.
    margin : int
        Whole cells beyond the box on every side.

    Examples
    --------
    >>> x, y = centred_nodes(np.array([0.0, 0.0]), np.array([2.5, 1.0]), 1.0, 1)
    >>> x.tolist(), y.tolist()
    ([-1.25, -0.25, 0.75, 1.75, 2.75, 3.75], [-1.0, 0.0, 1.0, 2.0])
    """
    cells = np.ceil((high - low) / step - 1e-9).astype(int) + 2 * margin
    x, y = (
        middle + step * (np.arange(count + 1) - 0.5 * count)
        for middle, count in zip(0.5 * (low + high), cells.tolist(), strict=True)
    )
    return x, y
