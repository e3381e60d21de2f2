r"""Closed lines around pieces, from the chains of border pixels that OpenCV follows (Suzuki & Abe 1985).

::

    . . . .        chain p → q → r: turning at q from the way back (to p) to the way on (to r), round the
    . p q .        outside, one passes q's outer neighbours; each of the four beside it is an edge that the
    . # # r        line crosses: above q, right of q

The same lines as `marching_squares.closed_lines` finds, in a twentieth of the time, wherever no two pieces
(or holes) touch by their corners alone.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import IntArray
from stackloft.sectioning.marching_squares import Crossings
from stackloft.sectioning.slice_pieces import pinched

_DIRECTION = np.array([5, 6, 7, 4, -1, 0, 3, 2, 1])
"""By 3·(1 + dy) + 1 + dx; y runs down, so that numbers run clockwise from the right."""
_LONE = np.array([0, 6, 4, 2])
"""The edges around a single pixel."""


def _passed(back: int, ahead: int) -> list[int]:
    """Return the neighbours beside a border pixel that one passes turning from `back` to `ahead`."""
    return [(back - turn) % 8 for turn in range(1, (back - ahead - 1) % 8 + 1) if (back - turn) % 2 == 0]


_PASSED = [_passed(back, ahead) for back in range(8) for ahead in range(8)]
_COUNT = np.array([len(ways) for ways in _PASSED])
_START = np.cumsum(_COUNT) - _COUNT
_WAYS = np.array([way for ways in _PASSED for way in ways])


def chain_lines(bits: NDArray[np.uint8], margin: int) -> list[Crossings] | None:
    """Return the closed lines around the pixels with 1, outlines all; None when that is not so simple.

    Parameters
    ----------
    bits : (rows, columns) array
        1 in the body.
    margin : int
        Pixels along the border of the crop that the body has to keep away from.

    Returns
    -------
    list of Crossings, or None
        None when there is a hole, a pinch, a body near the border, or nothing at all.

    Examples
    --------
    >>> bits = np.zeros((9, 9), np.uint8)
    >>> bits[3:5, 3:6] = 1
    >>> (line,) = chain_lines(bits, 2)
    >>> len(line.row)
    10
    """
    outlines, tree = cv2.findContours(np.ascontiguousarray(bits), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    if tree is None or (tree[0, :, 3] >= 0).any():
        return None
    chains = [outline[:, 0] for outline in outlines]
    if any(near_border(chain, bits.shape, margin) or pinched(bits, chain) for chain in chains):
        return None
    return [line_around(chain) for chain in chains]


def near_border(chain: NDArray[Any], shape: tuple[int, ...], margin: int) -> bool:
    """Return whether a chain comes within `margin` pixels of the border of a crop."""
    left, top, width, height = cv2.boundingRect(chain)
    return min(left, top) < margin or left + width > shape[1] - margin or top + height > shape[0] - margin


def line_around(chain: NDArray[Any]) -> Crossings:
    """Return the edges from a chain's border pixels, (k, 2) column and row, to their outer neighbours."""
    x, y = chain[:, 0].astype(np.int64), chain[:, 1].astype(np.int64)
    if len(chain) == 1:
        pixel, way = np.zeros(4, dtype=np.int64), _LONE
    else:
        pixel, way = _ways(3 * _steps(y) + _steps(x) + 4)
    row = y[pixel] - (way == 6)
    column = x[pixel] - (way == 4)
    return Crossings(row[::-1], column[::-1], (way & 3 == 2)[::-1])


def _ways(steps: IntArray) -> tuple[IntArray, IntArray]:
    """Return the chain's pixels, each as often as it is passed by, and the ways to its outer neighbours."""
    ahead = _DIRECTION[steps]
    back = np.concatenate([ahead[-1:], ahead[:-1]]) + 4 & 7
    turn = 8 * back + ahead
    count = _COUNT[turn]
    pixel = np.repeat(np.arange(len(steps)), count)
    before = np.cumsum(count) - count
    return pixel, _WAYS[np.arange(len(pixel)) + (_START[turn] - before)[pixel]]


def _steps(values: IntArray) -> IntArray:
    """Return the difference of each value and the next one, round the chain."""
    return np.concatenate([values[1:], values[:1]]) - values
