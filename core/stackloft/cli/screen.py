"""Consoles that people read."""

from __future__ import annotations

import sys

from rich.console import Console

_PIPE_WIDTH = 160
"""Columns when nobody watches: wide enough that a table in a file or pipe loses nothing."""


def console(*, stderr: bool = False) -> Console:
    """Return a console on stdout or stderr; as wide as the terminal, wide when there is none."""
    stream = sys.stderr if stderr else sys.stdout
    width = None if stream.isatty() else _PIPE_WIDTH
    return Console(stderr=stderr, highlight=False, width=width)
