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

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stackloft.model.slice_stack import Picture

BUDGET = 240_000_000
"""Bytes that are kept at most."""
STRIDE = 4
"""Of the pixels kept away from bodies."""
Window = tuple[slice, slice]


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
        wide = self.coarse.repeat(STRIDE, axis=0)[:rows].repeat(STRIDE, axis=1)[:, :columns]
        wide[self.window] = self.part
        wide.setflags(write=False)
        return wide


class KeptSlices:
    """A ``decode`` that answers from memory where it can.

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
        self._budget = budget
        self._kept: dict[int, _Kept] = {}

    def keep(self, number: int, picture: Picture, window: Window) -> None:
        """Keep what matters of a slice, unless too much has been kept already."""
        inside = picture[window]
        if inside.nbytes > self._budget:
            return
        self._budget -= inside.nbytes + picture.nbytes // STRIDE**2
        part = np.array(inside) if inside.nbytes < picture.nbytes else picture
        coarse = np.array(picture[::STRIDE, ::STRIDE])
        self._kept[number] = _Kept(part, window, coarse, picture.shape)

    def __call__(self, number: int) -> Picture:
        """Return the slice as it was kept, or decode it again."""
        kept = self._kept.get(number)
        return self._decode(number) if kept is None else kept.picture()


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
