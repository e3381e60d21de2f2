r"""The outline of the largest object in a picture, and the bands of pixels beside it.

::

    +---+---+---+---+      The bands lie within two pixels of the outline: they are sought in the tiles that
    |   |.-´|`-.|   |      it runs through, each with two pixels of its neighbours, all tiles at once. The
    +---+---+---+---+      rest of the picture, most of it, is not looked at.
    |  /|   |   |\  |
    +---+---+---+---+
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import cv2
import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from stackloft.model.arrays import BoolArray, IntArray
from stackloft.model.reused_memory import empty
from stackloft.model.segmentation import above
from stackloft.sectioning.large_masks import one_at_a_time
from stackloft_plugins.segmenters.body_window import Mask
from stackloft_plugins.segmenters.grey import Levels

_NEAR, _FAR = 1, 2  # pixels: the bands lie between these distances from the boundary
_TILE = 32
_SIDE = _TILE + 2 * _FAR


@dataclass(frozen=True, eq=False)
class Outline:
    """The border of an object whose holes are filled."""

    chain: NDArray[np.int32]
    """(k, 2) column, row of its border pixels in order around it; none of an empty picture."""
    shape: tuple[int, int]
    """(rows, columns) of the picture."""

    def mask(self) -> Mask:
        """Return 1 inside the outline, (rows, columns)."""
        return self._drawn(0)[_FAR : _FAR + self.shape[0], _FAR : _FAR + self.shape[1]]

    def part(self, window: tuple[slice, slice]) -> Mask:
        """Return the same in a window alone, whose bounds lie within the picture."""
        rows, columns = window
        height, width = (side.stop - side.start + 2 * _FAR for side in window)
        canvas = np.zeros(
            (height, width), np.uint8
        )  # wider: OpenCV cuts steps off at the border unlike others
        if len(self.chain):
            at = self.chain - np.array([columns.start - _FAR, rows.start - _FAR], np.int32)
            cv2.drawContours(canvas, [at], -1, 1, cv2.FILLED)
        return np.ascontiguousarray(canvas[_FAR:-_FAR, _FAR:-_FAR])

    @property
    def area(self) -> int:
        """Pixels inside, border pixels included."""
        return self._bands[2]

    @property
    def inner(self) -> IntArray:
        """The pixels 1 to 2 px inside, by their number row after row; of a small body its outermost ones."""
        return self._bands[0]

    @property
    def outer(self) -> IntArray:
        """The pixels 1 to 2 px outside, likewise."""
        return self._bands[1]

    @cached_property
    def _bands(self) -> tuple[IntArray, IntArray, int]:
        if not len(self.chain):
            nothing = np.zeros(0, dtype=np.int64)
            return nothing, nothing, 0
        with one_at_a_time(self.shape[0] * self.shape[1]):
            return self._sought()

    def _sought(self) -> tuple[IntArray, IntArray, int]:
        padded = self._drawn(1)  # beyond the picture there is no edge of the body
        tiles = self._tiles()
        within = _cut_out(padded, tiles)
        far = cv2.erode(within, _disc(_FAR))
        inner = self._numbers(cv2.erode(within, _disc(_NEAR)), far, tiles)
        if not len(inner):
            inner = self._numbers(within, far, tiles)
        area = cv2.countNonZero(padded[_FAR : _FAR + self.shape[0], _FAR : _FAR + self.shape[1]])
        _frame(padded, self.shape, 0)
        within = _cut_out(padded, tiles)
        near = cv2.dilate(within, _disc(_NEAR))
        return inner, self._numbers(cv2.dilate(within, _disc(_FAR)), near, tiles), area

    def _drawn(self, around: int) -> Mask:
        """Return the mask with a frame of `_FAR` pixels, and more until whole tiles are full."""
        rows, columns = (2 * _FAR + _TILE * -(-side // _TILE) for side in self.shape)
        padded = empty((rows, columns), np.uint8)
        padded.fill(0)
        if len(self.chain):
            cv2.drawContours(padded, [self.chain + np.int32(_FAR)], -1, 1, cv2.FILLED)
        if around:
            _frame(padded, self.shape, around)
        return padded

    def _tiles(self) -> tuple[IntArray, IntArray]:
        """Return row and column of the tiles that hold pixels at most `_FAR` away from the chain."""
        rows, columns = (-(-side // _TILE) for side in self.shape)
        used = np.zeros((rows, columns), dtype=np.bool_)
        chain = self.chain.astype(np.int64)
        low, high = (chain - _FAR) // _TILE, (chain + _FAR) // _TILE
        low, high = np.maximum(low, 0), np.minimum(high, [columns - 1, rows - 1])
        for column in (low[:, 0], high[:, 0]):
            for row in (low[:, 1], high[:, 1]):
                used[row, column] = True
        row, column = np.nonzero(used)
        return row.astype(np.int64), column.astype(np.int64)

    def _numbers(self, larger: object, smaller: object, tiles: tuple[IntArray, IntArray]) -> IntArray:
        """Return the picture's pixels that are in the larger of two masks of tiles alone."""
        only = np.asarray(larger, np.uint8) > np.asarray(smaller, np.uint8)
        middle = only.reshape(_SIDE, -1, _SIDE)[_FAR:-_FAR, :, _FAR:-_FAR]
        found = np.flatnonzero(np.ascontiguousarray(middle))
        row, place = np.divmod(found, _TILE * middle.shape[1])
        tile = place // _TILE
        row += _TILE * tiles[0][tile]
        column = _TILE * tiles[1][tile] + place % _TILE
        inside = (row < self.shape[0]) & (column < self.shape[1])
        numbers = row * self.shape[1] + column
        return np.asarray(numbers if inside.all() else numbers[inside], np.int64)


def main_outline(levels: Levels, level: float) -> Outline:
    """Return the outline of the object above a level that has the largest one, its holes filled.

    Examples
    --------
    >>> levels = np.zeros((40, 50), np.uint8)
    >>> levels[10:30, 10:40] = 9
    >>> levels[15, 15], levels[0, 0] = 0, 9
    >>> outline = main_outline(levels, 4.5)
    >>> outline.area, len(outline.inner), len(outline.outer)
    (600, 88, 108)
    """
    with one_at_a_time(levels.size):
        return outline_in(above(levels, level))


def outline_in(inside: BoolArray) -> Outline:
    """Return the same of a mask."""
    shape = (inside.shape[0], inside.shape[1])
    outlines, _ = cv2.findContours(inside.view(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    if not outlines:
        return Outline(np.zeros((0, 2), np.int32), shape)
    return Outline(np.asarray(max(outlines, key=cv2.contourArea)[:, 0], np.int32), shape)


def _frame(padded: Mask, shape: tuple[int, int], value: int) -> None:
    """Set what lies around the picture."""
    padded[:_FAR], padded[:, :_FAR] = value, value
    padded[_FAR + shape[0] :], padded[:, _FAR + shape[1] :] = value, value


def _cut_out(padded: Mask, tiles: tuple[IntArray, IntArray]) -> Mask:
    """Return tiles with their surroundings side by side, (_SIDE, n · _SIDE)."""
    down, along = padded.strides
    rows, columns = ((side - 2 * _FAR) // _TILE for side in padded.shape)
    strides = (down, _TILE * down, _TILE * along, along)
    every = as_strided(padded, (_SIDE, rows, columns, _SIDE), strides, writeable=False)
    return every[:, tiles[0], tiles[1]].reshape(_SIDE, -1)


@lru_cache
def _disc(radius: int) -> Mask:
    return np.asarray(
        cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1)), np.uint8
    )
