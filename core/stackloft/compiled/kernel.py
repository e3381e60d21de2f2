"""One compiled function, its types declared where it is first needed."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable
from typing import Any

from stackloft.compiled.library import kernels

_MOST = 4


def _processors() -> int:
    """Return how many processors this process may use."""
    usable = getattr(os, "sched_getaffinity", None)
    return len(usable(0)) if usable is not None else os.cpu_count() or 1


THREADS = min(_MOST, _processors())
"""Threads among which a kernel shares out slices or loops. They know nothing of the interpreter's lock, so
that small pieces of work gain by them too; more would only wait for memory."""


class Kernel:
    """A function of the library by its name, result and arguments.

    Examples
    --------
    >>> Kernel("no_such_function", ctypes.c_int).here() is None
    True
    """

    def __init__(self, name: str, result: Any, *arguments: Any) -> None:
        self._name, self._result, self._arguments = name, result, arguments
        self._library: ctypes.CDLL | None = None
        self._function: Callable[..., Any] | None = None

    def here(self) -> Callable[..., Any] | None:
        """Return the function; None where there are no compiled kernels, or they are not to be used now."""
        library = kernels()
        if library is None:
            return None
        if library is not self._library:
            self._function = self._declared(library)
            self._library = library
        return self._function

    def _declared(self, library: ctypes.CDLL) -> Callable[..., Any] | None:
        function = getattr(library, self._name, None)
        if function is not None:
            function.restype, function.argtypes = self._result, self._arguments
        return function
