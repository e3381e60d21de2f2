"""Large arrays whose memory is used again: slice after slice needs the same few.

The system's allocator gives such memory back and takes it anew, page by page, which costs as much time as
what is done in it; or it keeps it for each thread, so that several times what is needed stays taken.
"""

from __future__ import annotations

import math
import mmap
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

LARGE = 1_000_000
"""Bytes: smaller arrays are left to the allocator, unless their maker asks for less."""
SLICE = 250_000
"""Bytes of a scan's small slice, which has pieces of its own, lest it take a photograph's."""
_MOST = 3
"""Large pieces kept for the next ones to ask."""
_KEPT = 8_000_000
"""Bytes of smaller pieces kept likewise."""

_lock = threading.RLock()  # the last view of an array may go while its own thread asks for another one
_users = 0
_free: list[NDArray[np.uint8]] = []
_free_small: list[NDArray[np.uint8]] = []


class _Lent:
    """What an array's memory belongs to; when the last view of it goes, somebody else may have it."""

    def __init__(self, memory: NDArray[np.uint8], shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        self._memory = memory
        own = memory[: math.prod(shape) * dtype.itemsize].view(dtype).reshape(shape)
        self.__array_interface__ = own.__array_interface__

    def __del__(self) -> None:
        with _lock:
            if not _users:
                return
            if len(self._memory) >= LARGE and len(_free) < _MOST:
                _free.append(self._memory)
            if len(self._memory) < LARGE and sum(map(len, _free_small)) + len(self._memory) <= _KEPT:
                _free_small.append(self._memory)


def empty(shape: tuple[int, ...], dtype: DTypeLike, least: int = LARGE) -> NDArray[Any]:
    """Return an array that holds anything, as `numpy.empty` does; of `least` bytes or more from what is kept.

    Examples
    --------
    >>> with memory_reused():
    ...     first = empty((1000, 1000), np.uint8)
    ...     place = first.ctypes.data
    ...     del first
    ...     empty((500, 1000), np.int16).ctypes.data == place
    True
    """
    kind = np.dtype(dtype)
    size = math.prod(shape) * kind.itemsize
    if not _users or size < least:
        return np.empty(shape, kind)
    return np.asarray(_Lent(_taken(size), shape, kind))


@contextmanager
def memory_reused() -> Iterator[None]:
    """Keep the memory of large arrays that nobody needs any more for the next ones, until the end of this."""
    global _users  # noqa: PLW0603 - the memory is the process's
    with _lock:
        _users += 1
    try:
        yield
    finally:
        with _lock:
            _users -= 1
            if not _users:
                _free.clear()
                _free_small.clear()


def _taken(size: int) -> NDArray[np.uint8]:
    """Return the smallest free piece that is large enough, or a new one in place of one that is too small."""
    pieces = _free if size >= LARGE else _free_small
    with _lock:
        enough = [k for k, piece in enumerate(pieces) if len(piece) >= size]
        if enough:
            return pieces.pop(min(enough, key=lambda k: len(pieces[k])))
        if pieces:
            pieces.pop(max(range(len(pieces)), key=lambda k: len(pieces[k])))
    return np.frombuffer(mmap.mmap(-1, size), np.uint8)  # goes back to the system at once, when let go
