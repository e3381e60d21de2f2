"""Who is at work: notes that outlive the process, kept only where a supervisor reads them afterwards.

A note is one line of JSON in a file that both processes hold open::

    ["begin", thread, family, distribution, name, doing]     a plug-in is given control
    ["end", thread]                                          and gives it back
    ["part", path]  ["gone", path]                           a half-written file, and its end
    ["done", status]                                         no plug-in is at work any more

`faulthandler` writes the crashed thread's traceback into the same file.
"""

from __future__ import annotations

import faulthandler
import json
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, BinaryIO

from stackloft.registry.scan import Listing


class _Book:
    """Where this process keeps its notes; nowhere, unless it is supervised."""

    file: BinaryIO | None = None


def keep_notes(file: BinaryIO) -> None:
    """Keep notes in `file` from now on, the last words of a crashing thread among them."""
    _Book.file = file
    faulthandler.enable(file, all_threads=False)


def note(*words: Any) -> None:
    """Write one note; does nothing in a process that nobody supervises."""
    if _Book.file is not None:
        os.write(_Book.file.fileno(), f"{json.dumps(words)}\n".encode())


@contextmanager
def at_work(listing: Listing, doing: str) -> Iterator[None]:
    """Note that a plug-in is in control while the block runs.

    Parameters
    ----------
    listing : Listing
    doing : str
        ``import``, ``probe``, or the method's name.

    Examples
    --------
    >>> with at_work(Listing("reader", "acme", "acme-xct", "1.2", "acme_xct:Reader"), "probe"):
    ...     pass
    """
    if _Book.file is None:
        yield
        return
    thread = threading.get_ident()
    note("begin", thread, listing.family, listing.distribution, listing.name, doing)
    try:
        yield
    finally:
        note("end", thread)
