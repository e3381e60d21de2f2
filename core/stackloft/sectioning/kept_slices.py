r"""Pictures kept between finding the bodies and measuring one, so that no slice is decoded twice.

::

    +----------------+      whole: where bodies are, with a margin, as it was decoded;
    | . . . . . . .  |      dots: every fourth pixel of the rest, for people's thumbnails
    | . +-------+ .  |
    | . | body  | .  |      above BUDGET bytes nothing more is kept, and the slice is decoded again
    | . +-------+ .  |
    +----------------+

Which pieces are the body is known only when all slices have been seen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from stackloft.model.slice_stack import Picture, prefetch

BUDGET = 240_000_000
"""Bytes that are kept at most."""
PIECE = 1 << 24
ALIGNED = 64
"""Bytes: memory that is taken at once, and what copies begin at multiples of."""
STRIDE = 4
"""Of the pixels kept away from bodies."""
Window = tuple[slice, slice]
_BY_OPENCV = "BHhfd"
"""Kinds of numbers that OpenCV resizes."""


@dataclass(frozen=True, slots=True, eq=False)
class _Kept:
    part: Picture
    window: Window
    coarse: Picture
    shape: tuple[int, ...]

    def picture(self) -> Picture:
        """Return the slice, coarse away from the window; read-only as any decoded one."""
        if self.part.shape == self.shape:
            return self.part
        rows, columns = self.shape[:2]
        wide = _widened(self.coarse)[:rows, :columns]
        wide[self.window] = self.part
        wide.setflags(write=False)
        return wide


class _Shelf:
    """Copies of pictures in memory that is taken in large pieces, which the system hands out sooner.

    A scan's kept slices are mostly given up together, so that no piece outlives its other slices for long.
    """

    def __init__(self) -> None:
        self._free = np.zeros(0, np.uint8)

    def copied(self, picture: Picture) -> Picture:
        """Return a read-only copy, so that the rest of the picture need not stay in memory."""
        taken = -(-picture.nbytes // ALIGNED) * ALIGNED
        if taken > len(self._free):
            self._free = np.empty(max(PIECE, taken), np.uint8)
        copy = self._free[: picture.nbytes].view(picture.dtype).reshape(picture.shape)
        copy[...] = picture
        copy.setflags(write=False)
        self._free = self._free[taken:]
        return copy


def _widened(coarse: Picture) -> Picture:
    """Return the picture with every pixel `STRIDE` times as wide and as high."""
    if coarse.dtype.char in _BY_OPENCV and coarse.size:  # half the time, and other threads go on meanwhile
        size = (STRIDE * coarse.shape[1], STRIDE * coarse.shape[0])
        return np.asarray(cv2.resize(coarse, size, interpolation=cv2.INTER_NEAREST))
    return coarse.repeat(STRIDE, axis=0).repeat(STRIDE, axis=1)


class KeptSlices:
    """A ``decode`` that answers from memory where it can.

    Nothing is kept where the decoder has all slices at hand (`SliceStack.at_hand`).

    Examples
    --------
    >>> decoded = []
    >>> def decode(number):
    ...     decoded.append(number)
    ...     return np.full((8, 8), number)
    >>> kept = KeptSlices(decode)
    >>> kept.keep(1, decode(1), (slice(2, 4), slice(2, 4)))
    >>> int(kept(1).sum()), int(kept(0).sum()), decoded
    (64, 0, [1, 0])
    """

    def __init__(self, decode: Callable[[int], Picture], budget: int = BUDGET) -> None:
        self._decode = decode
        self._budget = 0 if getattr(decode, "at_hand", False) else budget
        self._shelf = _Shelf()
        self._kept: dict[int, _Kept] = {}

    def keep(self, number: int, picture: Picture, window: Window) -> None:
        """Keep what matters of a slice, unless too much has been kept already."""
        inside = picture[window]
        coarse = picture[:0, :0] if inside.shape == picture.shape else picture[::STRIDE, ::STRIDE]
        taken = inside.nbytes + coarse.nbytes
        if taken > self._budget:
            return
        self._budget -= taken
        copied = self._shelf.copied
        self._kept[number] = _Kept(copied(inside), window, copied(coarse), picture.shape)

    def part(self, number: int) -> tuple[Picture, Window]:
        """Return what is kept as it was decoded, and its rows and columns; of a slice not kept, all of it."""
        kept = self._kept.get(number)
        if kept is not None:
            return kept.part, kept.window
        picture = self._decode(number)
        return picture, (slice(0, picture.shape[0]), slice(0, picture.shape[1]))

    def prefetch(self, numbers: Sequence[int]) -> None:
        """Have the decoder get those ready that are not kept."""
        prefetch(self._decode, [number for number in numbers if number not in self._kept])

    def __call__(self, number: int) -> Picture:
        """Return the slice as it was kept, or decode it again."""
        kept = self._kept.get(number)
        return self._decode(number) if kept is None else kept.picture()


class Keeper:
    """Has each slice kept around the bodies that it and those beside it show, whose slabs share its voxels.

    Examples
    --------
    >>> kept = KeptSlices(lambda number: np.zeros((9, 9)))
    >>> keeper = Keeper(kept)
    >>> for number, rows in enumerate((slice(2, 4), slice(3, 5), None)):
    ...     keeper.take(number, np.arange(81.0).reshape(9, 9), rows and (rows, slice(0, 9)))
    >>> keeper.end()
    >>> [kept(number)[[2, 4], 1].tolist() for number in range(3)]
    [[19.0, 37.0], [19.0, 37.0], [0.0, 37.0]]
    """

    def __init__(self, kept: KeptSlices) -> None:
        self._kept = kept
        self._before: Window | None = None
        self._last: tuple[int, Picture, Window | None] | None = None

    def take(self, number: int, picture: Picture, window: Window | None) -> None:
        """Take a slice with the window around its bodies, if any; the slice before is kept now."""
        self._keep(window)
        self._before = self._last[2] if self._last is not None else None
        self._last = (number, picture, window)

    def end(self) -> None:
        """Have the last slice kept."""
        self._keep(None)
        self._last = None

    def _keep(self, after: Window | None) -> None:
        if self._last is not None:
            number, picture, own = self._last
            near = [window for window in (self._before, own, after) if window is not None]
            self._kept.keep(number, picture, _joined(near))


def _joined(windows: list[Window]) -> Window:
    """Return the window that holds all of them; an empty one holds none."""
    rows, columns = (
        slice(min(part.start for part in parts), max(part.stop for part in parts))
        for parts in (zip(*windows, strict=True) if windows else ([slice(0, 0)], [slice(0, 0)]))
    )
    return rows, columns


class Peeked:
    """A ``decode`` that gives a slice once more from memory after `peek` has decoded it.

    Examples
    --------
    >>> decoded = []
    >>> def decode(number):
    ...     decoded.append(number)
    ...     return np.zeros((2, 2))
    >>> peeked = Peeked(decode)
    >>> _ = peeked.peek(3), peeked(3), peeked(4)
    >>> decoded
    [3, 4]
    """

    def __init__(self, decode: Callable[[int], Picture], budget: int = BUDGET) -> None:
        self._decode = decode
        self._budget = budget
        self._seen: dict[int, Picture] = {}

    @property
    def at_hand(self) -> bool:
        """As the decoder says."""
        return bool(getattr(self._decode, "at_hand", False))

    @property
    def slow(self) -> bool:
        """As the decoder says."""
        return bool(getattr(self._decode, "slow", False))

    def prefetch(self, numbers: Sequence[int]) -> None:
        """Have the decoder get those ready that have not been peeked at."""
        prefetch(self._decode, [number for number in numbers if number not in self._seen])

    def peek(self, number: int) -> Picture:
        """Return the slice, and remember it for the next time it is asked for, within the budget."""
        picture = self._seen[number] if number in self._seen else self._decode(number)
        if number not in self._seen and picture.nbytes <= self._budget:
            self._seen[number] = picture
            self._budget -= picture.nbytes
        return picture

    def __call__(self, number: int) -> Picture:
        """Return the slice; one that was peeked at is forgotten now."""
        picture = self._seen.pop(number, None)
        return self._decode(number) if picture is None else picture
