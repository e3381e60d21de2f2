r"""Closed lines around pieces, from the chains of border pixels that OpenCV follows (Suzuki & Abe 1985).

::

    . . . .        chain p → q → r: turning at q from the way back (to p) to the way on (to r), round the
    . p q .        outside, one passes q's outer neighbours; each of the four beside it is an edge that the
    . # # r        line crosses: above q, right of q

The same lines as `marching_squares.closed_lines` finds, in a tenth of the time, wherever no two pieces (or
holes) touch by their corners alone.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.sectioning.linked_pieces import pinched
from stackloft.sectioning.marching_squares import Crossings

_DIRECTION = np.array([[5, 6, 7], [4, -1, 0], [3, 2, 1]])
"""By 1 + dy and 1 + dx; y runs down, so that numbers run clockwise from the right."""
_AROUND = np.arange(1, 8)


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
    limit = np.array(bits.shape[::-1]) - 1 - margin
    for outline in outlines:
        chain = outline[:, 0]
        if chain.min() < margin or (chain.max(axis=0) > limit).any() or pinched(bits, chain):
            return None
    return [_crossed(outline[:, 0]) for outline in outlines]


def _crossed(chain: NDArray[Any]) -> Crossings:
    """Return the edges between the border pixels of a chain and their outer neighbours, in order."""
    x, y = chain[:, 0].astype(np.int64), chain[:, 1].astype(np.int64)
    if len(chain) == 1:
        back, count = np.array([0]), np.array([8])
    else:
        ahead = _DIRECTION[1 + np.roll(y, -1) - y, 1 + np.roll(x, -1) - x]
        back = (np.roll(ahead, 1) + 4) % 8
        count = (back - ahead - 1) % 8
    turns = np.arange(0, 8) if len(chain) == 1 else _AROUND
    way = (back[:, None] - turns) % 8
    crossed = (turns <= count[:, None]) & (way % 2 == 0)
    pixel, _ = np.nonzero(crossed)
    way = way[crossed]
    row = y[pixel] - (way == 6)
    column = x[pixel] - (way == 4)
    return Crossings(row[::-1], column[::-1], (way % 4 == 2)[::-1])
