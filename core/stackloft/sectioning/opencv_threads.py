"""OpenCV's own threads put aside while threads of ours share its work out already."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

import cv2

_lock = threading.Lock()
_users = 0
_before = 0


@contextmanager
def without_opencv_threads() -> Iterator[None]:
    """Let OpenCV work in its caller's thread alone, as it did before when the last one leaves.

    Where two threads share two processors, splitting small pieces of work again only makes them wait.
    The setting is the process's; results do not depend on it.

    Examples
    --------
    >>> before = cv2.getNumThreads()
    >>> with without_opencv_threads(), without_opencv_threads():
    ...     cv2.getNumThreads()
    1
    >>> cv2.getNumThreads() == before
    True
    """
    global _users, _before  # noqa: PLW0603 - so is OpenCV's own setting
    with _lock:
        if _users == 0:
            _before = cv2.getNumThreads()
            cv2.setNumThreads(1)
        _users += 1
    try:
        yield
    finally:
        with _lock:
            _users -= 1
            if _users == 0:
                cv2.setNumThreads(_before)
