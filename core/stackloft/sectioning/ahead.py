"""Work on slices a little ahead of the one in hand, or behind it, in order."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

from stackloft.model.slice_stack import SectionKind, SliceStack

THREADS = 2
"""Threads that decode and segment, and as many that work behind."""

AHEAD = 3
"""Slices worked on before they are asked for; with the one in hand, the pictures in memory."""

SMALL = 700_000
"""Pixels: a scan's slices of fewer are worked on one after the other, unless they are slow to decode. Each
takes some hundred calls of a few microseconds; two threads that pass the interpreter's lock to and fro
between them take longer than one."""

LARGE = 4_000_000
"""Pixels: of larger pictures no more are held than there are threads."""

TOGETHER = 8
"""Small slices worked on together: compiled kernels share them out among threads."""

HELD = 4_000_000
"""Bytes: slices whose fields take more are not held for others to come."""

T = TypeVar("T")


def ahead_on(stack: SliceStack) -> int:
    """Return how many slices of a stack are best worked on before they are asked for; 0: none, in no thread.

    Examples
    --------
    >>> import numpy as np
    >>> z, spacing = np.arange(2.0), np.ones((2, 2))
    >>> def of(side, kind):
    ...     return ahead_on(SliceStack(lambda k: None, ("a", "b"), (side, side), z, spacing, kind))
    >>> of(512, SectionKind.SLAB), of(512, SectionKind.FACE), of(3000, SectionKind.SLAB)
    (0, 3, 1)
    """
    pixels = stack.shape[0] * stack.shape[1]
    if pixels < SMALL and stack.kind is SectionKind.SLAB and not stack.slow:
        return 0
    return AHEAD if pixels < LARGE else 1


def groups_of(count: int, size: int) -> list[range]:
    """Return the numbers from 0 to `count` - 1 in groups of at most `size`.

    Examples
    --------
    >>> groups_of(5, 2)
    [range(0, 2), range(2, 4), range(4, 5)]
    """
    return [range(start, min(count, start + size)) for start in range(0, count, size)]


def worked_ahead(count: int, work: Callable[[int], T], ahead: int = AHEAD) -> Iterator[T]:
    """Yield ``work(0)`` … ``work(count - 1)`` in order, worked out a little ahead.

    Two threads work at most `ahead` numbers ahead of the one in hand; of 0, each is worked out when it is
    asked for. Closing the iterator, or an error in one piece of work, ends the work on those not begun.

    Examples
    --------
    >>> list(worked_ahead(5, lambda number: number**2))
    [0, 1, 4, 9, 16]
    """
    if not ahead:
        yield from map(work, range(count))
        return
    pool = ThreadPoolExecutor(THREADS, thread_name_prefix="stackloft-decode")
    waiting: deque[Future[T]] = deque()
    try:
        for index in range(count):
            waiting.append(pool.submit(work, index))
            if len(waiting) > ahead:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


class Behind:
    """Work done by threads of its own while its giver goes on.

    At most one piece waits while others are worked on, so that what they hold does not pile up. With no
    threads each piece is done as it is given.

    Examples
    --------
    >>> behind = Behind()
    >>> for number in (1, 2, 3):
    ...     behind.give(lambda number=number: number**2)
    >>> behind.finished()
    [1, 4, 9]
    """

    def __init__(self, threads: int = THREADS) -> None:
        self._threads = threads
        self._pool = ThreadPoolExecutor(max(threads, 1), thread_name_prefix="stackloft-behind")
        self._given: deque[Future[Any]] = deque()
        self._done: list[Any] = []

    def give(self, work: Callable[[], Any]) -> None:
        """Have a piece of work done.

        Raises
        ------
        Exception
            What an earlier piece raised, or this one without threads; nothing more is worked on then.
        """
        if not self._threads:
            self._done.append(work())
            return
        while len(self._given) > THREADS:
            self._take()
        self._given.append(self._pool.submit(work))

    def finished(self) -> list[Any]:
        """Return what the pieces gave, in order, when all are done.

        Raises
        ------
        Exception
            What one of them raised.
        """
        self.settle()
        self._pool.shutdown()
        return self._done

    def settle(self) -> None:
        """Wait until all that was given is done; raise what a piece raised."""
        while self._given:
            self._take()

    def _take(self) -> None:
        try:
            self._done.append(self._given.popleft().result())
        except BaseException:
            self._pool.shutdown(wait=True, cancel_futures=True)
            raise
