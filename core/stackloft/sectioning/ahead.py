"""Work on slices a little ahead of the one in hand, or behind it, in order."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

THREADS = 2
"""Threads that decode and segment, and as many that work behind."""

AHEAD = 3
"""Slices worked on before they are asked for; with the one in hand, the pictures in memory."""

T = TypeVar("T")


def worked_ahead(count: int, work: Callable[[int], T], ahead: int = AHEAD) -> Iterator[T]:
    """Yield ``work(0)`` … ``work(count - 1)`` in order, worked out a little ahead.

    Two threads work at most `ahead` numbers ahead of the one in hand. Closing the iterator, or an error in
    one piece of work, ends the work on those not begun.

    Examples
    --------
    >>> list(worked_ahead(5, lambda number: number**2))
    [0, 1, 4, 9, 16]
    """
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

    At most one piece waits while others are worked on, so that what they hold does not pile up.

    Examples
    --------
    >>> behind = Behind()
    >>> for number in (1, 2, 3):
    ...     behind.give(lambda number=number: number**2)
    >>> behind.finished()
    [1, 4, 9]
    """

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(THREADS, thread_name_prefix="stackloft-behind")
        self._given: deque[Future[Any]] = deque()
        self._done: list[Any] = []

    def give(self, work: Callable[[], Any]) -> None:
        """Have a piece of work done.

        Raises
        ------
        Exception
            What an earlier piece raised; nothing more is worked on then.
        """
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
