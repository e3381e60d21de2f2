"""The ``stackloft`` command.

`main` imports the commands' signatures alone; what a command does is imported when it runs, so that
``stackloft --help`` stays quick.
"""

from __future__ import annotations


def main() -> None:
    """Run the command line and leave with its exit status."""
    from stackloft.cli.app import app  # noqa: PLC0415 - importing stackloft.cli imports no Typer

    app()
