"""Work on slices a little ahead of the one in hand, in order."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

THREADS = 2
"""Threads that decode and segment."""

AHEAD = 3
"""Slices worked on before they are asked for; with the one in hand, the pictures in memory."""

T = TypeVar("T")


def worked_ahead(count: int, work: Callable[[int], T]) -> Iterator[T]:
    """Yield ``work(0)`` … ``work(count - 1)`` in order, worked out a little ahead.

    Two threads work at most `AHEAD` numbers ahead of the one in hand. Closing the iterator, or an error in
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
            if len(waiting) > AHEAD:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
