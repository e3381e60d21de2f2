r"""Voids inside bodies: background that nowhere reaches the pictures' border, seen across all slices.

::

    +-----------+        o: a piece of background without contact to the border. It is a void only when
    |  #######  |        no neighbouring slice shows it continued to the outside: a hole that is open
    |  ##o####  |        above or below, or a cup, is no void. A piece continues where half of the smaller
    |  #######  |        one overlaps; two walls that cross between slices make no passage.
    +-----------+        Where the scan ends inside the body, nobody has seen it open: it counts as closed.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.solid_piece import Cracks
from stackloft.geometry.disc_reach import disc_reach
from stackloft.model.arrays import BoolArray, FloatArray
from stackloft.model.notices import Notice
from stackloft.sectioning.linked_pieces import LinkedPieces
from stackloft.sectioning.slice_pieces import Corner, Pieces, pieces_of

CONTINUED = 0.5
"""Least part of the smaller of two pieces of background that makes them one across slices."""


CRACK = 2
"""Pixels: a passage no wider than twice this is none; it counts as void, with what lies behind it."""
_ENDLESS = 1e18  # pixels of the outer background, which is larger than any void
_DISC = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * CRACK + 1, 2 * CRACK + 1))
_FEWEST = 20  # pixels of a crack; fewer are the staircase of a slanting boundary
CRACKS = Cracks(disc_reach(_DISC), _FEWEST, frame=2 * CRACK + 1)
"""The same for a body of one piece without a hole."""


def outer_background(body: BoolArray, *, crumbs: bool = True) -> BoolArray:
    """Return the background of a slice that is joined to its border by more than a crack.

    Background opened by a disc (Serra 1982), as far as it reaches the border; `crumbs`: cracks of less than
    20 pixels are given back.

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
    framed = np.pad(background, 2 * CRACK, constant_values=1)
    wide, _ = pieces_of(cv2.erode(framed, _DISC, borderValue=1) > 0)
    reached = cv2.dilate((wide == wide[0, 0]).astype(np.uint8), _DISC)[
        2 * CRACK : -2 * CRACK, 2 * CRACK : -2 * CRACK
    ]
    rest, sizes = pieces_of((background > reached), connectivity=8)
    short = np.concatenate([[False], sizes < _FEWEST])[rest]
    border = np.unique(np.concatenate([rest[0], rest[-1], rest[:, 0], rest[:, -1]]))
    joined = np.isin(rest, border[border > 0])
    given_back = short & _beside(reached, rest) if crumbs else np.zeros_like(short)
    return np.asarray((background > 0) & ((reached > 0) | given_back | joined))


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


def closed_background(body: BoolArray, *, solid: bool = False, apart: bool = False) -> Pieces | None:
    """Return the numbered pieces of background that `outer_background` does not reach; None: there are none.

    Most slices have none, which their outlines tell without looking at every pixel. `solid`: the body is
    known to have no hole; `apart`: to lie more than two cracks' width off the border.
    """
    if _surely_open(body.view(np.uint8), solid=solid, apart=apart):
        return None
    pieces, sizes = pieces_of(~(body | outer_background(body)), connectivity=8)
    return pieces if len(sizes) else None


def _surely_open(bits: NDArray[np.uint8], *, solid: bool, apart: bool) -> bool:
    """Return True when there is no hole, none behind a passage closed by the disc, and no long crack.

    The disc's closing of the body is the complement of the background's opening.
    """
    if not apart and any(edge.any() for edge in _strips(bits, 1)):
        return False
    if not solid and _has_holes(np.ascontiguousarray(bits)):
        return False
    framed = bits
    if not apart and any(edge.any() for edge in _strips(bits, 2 * CRACK)):
        around = (2 * CRACK,) * 4
        framed = np.asarray(
            cv2.copyMakeBorder(bits, *around, borderType=cv2.BORDER_CONSTANT, value=0), np.uint8
        )
    wide = cv2.dilate(framed, _DISC)
    # one piece stays one when it grows: more lines than its outline are holes, and are counted sooner
    if len(cv2.findContoursLinkRuns(wide)[0]) > 1 if solid else _has_holes(wide):
        return False
    shut = cv2.erode(wide, _DISC)
    if cv2.countNonZero(shut) - cv2.countNonZero(framed) < _FEWEST:
        return True
    return bool(pieces_of(cv2.subtract(shut, framed) > 0, connectivity=8)[1].max() < _FEWEST)


def _strips(bits: NDArray[np.uint8], width: int) -> tuple[NDArray[np.uint8], ...]:
    """Return the outermost rows and columns."""
    return bits[:width], bits[-width:], bits[:, :width], bits[:, -width:]


def _has_holes(bits: cv2.typing.MatLike) -> bool:
    _, tree = cv2.findContours(bits, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_SIMPLE)
    return tree is not None and bool((tree[0, :, 3] >= 0).any())


_OUTSIDE_ALONE: FloatArray = np.array([_ENDLESS])
_NOWHERE: BoolArray = np.zeros((0, 0), dtype=np.bool_)


@dataclass(frozen=True, slots=True, eq=False)
class _Slice:
    """A slice's body on a window, and the background that is closed in."""

    body: BoolArray
    closed: Pieces | None
    corner: Corner

    def numbered(self, window: tuple[int, int, int, int]) -> Pieces:
        """Return 1 for the outer background, 2 … for what is closed in, 0 for body, on a wider window.

        Short cracks lead nowhere, as long ones do not: behind one on the next slice no void lies open.
        """
        top, left, bottom, right = window
        numbers = np.ones((bottom - top, right - left), dtype=np.int32)
        rows, columns = self.body.shape
        row, column = self.corner[0] - top, self.corner[1] - left
        part = numbers[row : row + rows, column : column + columns]
        np.copyto(part, outer_background(self.body, crumbs=False))
        if self.closed is not None:
            np.copyto(part, self.closed + 1, where=self.closed > 0)
        return numbers


class VoidFinder:
    """Takes the body's pixels slice by slice; then knows which background is closed in.

    Examples
    --------
    >>> body = np.ones((5, 5), dtype=bool)
    >>> hollow = body.copy()
    >>> hollow[2, 2] = False
    >>> finder = VoidFinder()
    >>> for mask in (body, hollow, body):
    ...     framed = np.pad(mask, 1)
    ...     finder.add(framed, closed_background(framed))
    >>> [int(finder.closed(k)[0].sum()) for k in range(3)]
    [0, 1, 0]
    """

    def __init__(self) -> None:
        self._links = LinkedPieces(CONTINUED)
        self._outside: list[BoolArray] = []
        self._closed: BoolArray | None = None
        self._showing: frozenset[int] | None = None
        self._last: _Slice | None = None

    def add(self, body: BoolArray, closed: Pieces | None, corner: Corner = (0, 0)) -> None:
        """Take a slice: True where any body is, on a window of it, and its `closed_background`."""
        now, before = _Slice(body, closed, corner), self._last
        if closed is None and (before is None or before.closed is None):  # as on most slices
            self._links.add(_NOWHERE, _OUTSIDE_ALONE, None, corner)
            self._outside.append(_OUTSIDE_ALONE > 0.0)
            self._last = now
            return
        sizes = np.bincount(closed.ravel())[1:] if closed is not None else np.zeros(0)
        window = _around(now, before or now)
        anew = (before.numbered(window), window[:2]) if before is not None else None
        every = np.concatenate([[_ENDLESS], sizes])
        self._links.add(now.numbered(window), every, None, window[:2], anew)
        self._outside.append(np.arange(1 + len(sizes)) == 0)
        self._last = now

    def closed(self, number: int) -> tuple[BoolArray, Corner]:
        """Return the pixels of a crop of slice `number` that lie in a void, and the crop's corner."""
        if not self.has_closed(number):
            return _NOWHERE, (0, 0)
        own = self._pieces()[self._links.of_slice(number)]
        pieces, corner = self._links.pieces(number)
        return np.concatenate([[False], own])[pieces], corner

    def has_closed(self, number: int) -> bool:
        """Return whether slice `number` shows any void."""
        if self._showing is None:
            every, closed = range(len(self._links)), self._pieces()
            several = bool(closed.any())
            self._showing = frozenset(k for k in every if several and closed[self._links.of_slice(k)].any())
        return number in self._showing

    def _pieces(self) -> BoolArray:
        """Return whether each piece of background belongs to a void."""
        if self._closed is None:
            objects = self._links.objects()
            outside = np.concatenate(self._outside)
            open_objects = np.zeros(int(objects.max(initial=-1)) + 1, dtype=np.bool_)
            open_objects[objects[outside]] = True
            self._closed = ~open_objects[objects]
        return self._closed


def _around(a: _Slice, b: _Slice) -> tuple[int, int, int, int]:
    """Return top, left, bottom, right of the window that holds both slices' windows."""
    top, left = (min(a.corner[k], b.corner[k]) for k in (0, 1))
    bottom, right = (max(one.corner[k] + one.body.shape[k] for one in (a, b)) for k in (0, 1))
    return top, left, bottom, right
