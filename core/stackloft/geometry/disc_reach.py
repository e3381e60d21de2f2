"""A symmetric structuring element by how far its rows reach."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def disc_reach(disc: NDArray[Any]) -> NDArray[np.int32]:
    """Return how far each row of a disc reaches to either side, (r + 1), from the middle row outwards.

    Parameters
    ----------
    disc : (2 r + 1, 2 r + 1) array
        Not 0 in the disc, which is the same upside down and left to right.

    Examples
    --------
    >>> disc_reach(np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]])).tolist()
    [1, 0]
    """
    middle = len(disc) // 2
    return np.asarray(np.count_nonzero(disc[middle:], axis=1) // 2, np.int32)
