"""The ``stackloft`` command.

`main` imports the commands' signatures alone; what a command does is imported when it runs, so that
``stackloft --help`` stays quick.
"""

from __future__ import annotations

import os
import sys


def main() -> None:
    """Run the command line and leave with its exit status."""
    # The matrices here are small: a second thread in them waits more than it works (user time × 2).
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        if "_STACKLOFT_COMPLETE" in os.environ:  # a shell asks what may come next
            from stackloft.cli.completion.answer import answer  # noqa: PLC0415

            answer(os.environ)
            return
        from stackloft.cli.app import app  # noqa: PLC0415 - importing stackloft.cli imports no Typer
        from stackloft.cli.guard import Supervision  # noqa: PLC0415

        Supervision.wanted = True
        app()
    except KeyboardInterrupt:  # while commands are imported; a command itself answers in `guard`
        print("stackloft: interrupted", file=sys.stderr)  # noqa: T201
        sys.exit(130)
