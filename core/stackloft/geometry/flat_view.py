"""A picture's pixels as one row, to be taken by number; a window of a larger picture is not copied."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

IntArray = NDArray[np.int64]


def flat_view(pixels: NDArray[Any]) -> tuple[NDArray[Any], int]:
    """Return the pixels row after row, and how many there are from one row's first to the next one's.

    Of a window of a larger picture, what lies beside it between two of its rows is there too.

    Parameters
    ----------
    pixels : (rows, columns) array

    Examples
    --------
    >>> whole = np.arange(20).reshape(4, 5)
    >>> flat, width = flat_view(whole[1:3, 2:4])
    >>> flat.tolist(), width
    ([7, 8, 9, 10, 11, 12, 13], 5)
    >>> flat_view(whole[:, ::2])[1]
    3
    """
    rows, columns = pixels.shape
    down, along = pixels.strides
    if along != pixels.itemsize or down % along or down < columns * along or not pixels.size:
        return np.ascontiguousarray(pixels).ravel(), columns
    width = down // along
    return as_strided(pixels, ((rows - 1) * width + columns,), (along,), writeable=False), width


def taken(pixels: NDArray[Any], numbers: IntArray) -> NDArray[Any]:
    """Return the pixels of these numbers, (n), counted row after row from 0 within the picture.

    Examples
    --------
    >>> whole = np.arange(20).reshape(4, 5)
    >>> taken(whole[1:3, 2:4], np.array([1, 2])).tolist()
    [8, 12]
    """
    flat, width = flat_view(pixels)
    columns = pixels.shape[1]
    beside = width - columns
    return flat.take(numbers + beside * (numbers // columns) if beside else numbers)
