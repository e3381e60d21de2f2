"""Large masks one at a time: what threads that share a stack's slices hold together stays small."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

LARGE = 2_000_000
"""Pixels."""
_lock = threading.Lock()


@contextmanager
def one_at_a_time(pixels: int) -> Iterator[None]:
    """Let nobody else work on a large mask meanwhile; small ones do not wait.

    A mask and the copy that OpenCV makes of it to follow its borders take as much as the levels it comes
    from, but for a few milliseconds only. Not to be nested.

    Examples
    --------
    >>> with one_at_a_time(12_000_000), one_at_a_time(100):
    ...     pass
    """
    if pixels < LARGE:
        yield
        return
    with _lock:
        yield
