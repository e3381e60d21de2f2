r"""Voids inside bodies: background that nowhere reaches the pictures' border, seen across all slices.

::

    +-----------+        o: a piece of background without contact to the border. It is a void only when
    |  #######  |        no neighbouring slice shows it continued to the outside: a hole that is open
    |  ##o####  |        above or below, or a cup, is no void. A piece continues where half of the smaller
    |  #######  |        one overlaps; two walls that cross between slices make no passage.
    +-----------+        Where the scan ends inside the body, nobody has seen it open: it counts as closed.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import BoolArray
from stackloft.model.notices import Notice
from stackloft.sectioning.linked_pieces import LinkedPieces, pieces_of

CONTINUED = 0.5
"""Least part of the smaller of two pieces of background that makes them one across slices."""


CRACK = 2
"""Pixels: a passage no wider than twice this is none; it counts as void, with what lies behind it."""
_FEWEST = 20  # pixels of a crack; fewer are the staircase of a slanting boundary


def outer_background(body: BoolArray) -> BoolArray:
    """Return the background of a slice that is joined to its border by more than a crack.

    Background opened by a disc (Serra 1982), as far as it reaches the border; crumbs are given back.

    Examples
    --------
    >>> body = np.zeros((40, 40), dtype=bool)
    >>> body[5:35, 5:35] = True
    >>> body[15:25, 15:25] = False          # a void of 100 pixels
    >>> body[6:15, 20] = False              # and a crack of 9, closed by one pixel of body
    >>> int((~body & ~outer_background(body)).sum())
    109
    """
    background = (~body).astype(np.uint8)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * CRACK + 1, 2 * CRACK + 1))
    framed = np.pad(background, 2 * CRACK, constant_values=1)
    wide, _ = pieces_of(cv2.erode(framed, disc, borderValue=1) > 0)
    reached = cv2.dilate((wide == wide[0, 0]).astype(np.uint8), disc)[
        2 * CRACK : -2 * CRACK, 2 * CRACK : -2 * CRACK
    ]
    rest, sizes = pieces_of((background > reached), connectivity=8)
    crumbs = np.concatenate([[False], sizes < _FEWEST])[rest]
    border = np.unique(np.concatenate([rest[0], rest[-1], rest[:, 0], rest[:, -1]]))
    joined = np.isin(rest, border[border > 0])
    return np.asarray((background > 0) & ((reached > 0) | (crumbs & _beside(reached, rest)) | joined))


def _beside(reached: cv2.typing.MatLike, rest: NDArray[np.int32]) -> BoolArray:
    """Return the pixels of those pieces of `rest` that touch what was reached."""
    touched = np.unique(rest[cv2.dilate(reached, np.ones((3, 3), np.uint8)) > 0])
    return np.isin(rest, touched[touched > 0])


def void_notice(voids: float, solid: float, *, filled: bool) -> tuple[Notice, ...]:
    """Return a notice of a body's voids, both in mm³, and of its porosity: their part of the whole.

    Examples
    --------
    >>> void_notice(25.0, 75.0, filled=False)[0].message
    'voids of 25 mm³ (porosity 25 %) are left out; --set segmenter.voids=fill counts them as body'
    """
    if not voids:
        return ()
    share = f"voids of {voids:.4g} mm³ (porosity {100 * voids / (voids + solid):.3g} %)"
    if filled:
        text = f"{share} are counted as body; --set segmenter.voids=keep leaves them out"
        return (Notice("voids-filled", text),)
    return (Notice("voids-kept", f"{share} are left out; --set segmenter.voids=fill counts them as body"),)


class VoidFinder:
    """Takes the body's pixels slice by slice; then knows which background is closed in.

    Examples
    --------
    >>> body = np.ones((5, 5), dtype=bool)
    >>> hollow = body.copy()
    >>> hollow[2, 2] = False
    >>> finder = VoidFinder()
    >>> for mask in (body, hollow, body):
    ...     finder.add(np.pad(mask, 1))
    >>> [int(finder.closed(k).sum()) for k in range(3)]
    [0, 1, 0]
    """

    def __init__(self) -> None:
        self._links = LinkedPieces(CONTINUED)
        self._outside: list[BoolArray] = []
        self._closed: BoolArray | None = None

    def add(self, body: BoolArray) -> None:
        """Take a slice: True where any body is."""
        outside = outer_background(body)
        pieces, sizes = pieces_of(~(body | outside), connectivity=8)
        numbered = np.where(pieces > 0, pieces + 1, outside).astype(np.int32)
        self._links.add(numbered, np.concatenate([[float(outside.sum())], sizes]))
        self._outside.append(np.arange(1 + len(sizes)) == 0)

    def closed(self, number: int) -> BoolArray:
        """Return the pixels of slice `number` that lie in a void."""
        pieces = self._links.pieces(number)
        return np.asarray(np.concatenate([[False], self._pieces()[self._links.of_slice(number)]])[pieces])

    def has_closed(self, number: int) -> bool:
        """Return whether slice `number` shows any void."""
        return bool(self._pieces()[self._links.of_slice(number)].any())

    def _pieces(self) -> BoolArray:
        """Return whether each piece of background belongs to a void."""
        if self._closed is None:
            objects = self._links.objects()
            outside = np.concatenate(self._outside)
            open_objects = np.zeros(int(objects.max(initial=-1)) + 1, dtype=np.bool_)
            open_objects[objects[outside]] = True
            self._closed = ~open_objects[objects]
        return self._closed
