"""The library of compiled kernels, loaded once; None where it is not there, or not the sources'."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from stackloft.compiled.building import LIBRARY, SWITCH, fingerprint, wanted

# Two threads that ask `cache` at once may load twice, and argument types are declared on one of the two.
_LOADING = threading.Lock()
_HIDDEN: list[None] = []
"""One entry for each ``without_kernels()`` that is open."""


def kernels() -> ctypes.CDLL | None:
    """Return the library of kernels, None where NumPy has to do.

    Examples
    --------
    >>> (kernels() is None) == bool(why_not())
    True
    """
    return None if _HIDDEN else _loaded()[0]


def why_not() -> str:
    """Return why there are no kernels, empty when there are."""
    return "hidden by without_kernels()" if _HIDDEN else _loaded()[1]


@contextmanager
def without_kernels() -> Iterator[None]:
    """Hide the kernels from the whole process for a while: for tests that compare them with NumPy.

    Examples
    --------
    >>> with without_kernels():
    ...     kernels(), why_not()
    (None, 'hidden by without_kernels()')
    """
    _HIDDEN.append(None)
    try:
        yield
    finally:
        _HIDDEN.pop()


def load(path: Path) -> tuple[ctypes.CDLL | None, str]:
    """Load a library of kernels; return it, or None and the reason.

    Examples
    --------
    >>> load(Path("nowhere.so"))
    (None, 'nowhere.so is not there: it was not compiled')
    """
    if not path.exists():
        return None, f"{path} is not there: it was not compiled"
    try:
        library = ctypes.CDLL(str(path))
        compiled_from = library.stackloft_abi()
        sources = fingerprint()
    except (OSError, AttributeError) as error:  # another machine's, half a file, or somebody else's library
        return None, f"{path} does not load: {error}"
    if compiled_from != sources:
        return None, f"{path} was compiled from other sources than those beside it"
    return library, ""


def _loaded() -> tuple[ctypes.CDLL | None, str]:
    with _LOADING:
        return _loaded_once()


@cache
def _loaded_once() -> tuple[ctypes.CDLL | None, str]:
    if not wanted():
        return None, f"the environment variable {SWITCH} is 0"
    return load(LIBRARY)
