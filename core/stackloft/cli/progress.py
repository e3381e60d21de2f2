"""What a run is doing, shown on stderr while a person watches."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    SpinnerColumn,
    TextColumn,
    TimeElapsedColumn,
)

from stackloft.pipeline.progress import Progress as Listener
from stackloft.pipeline.progress import Silence


class RichProgress:
    """A `stackloft.pipeline.progress.Progress` that draws one line per stage."""

    def __init__(self, display: Progress) -> None:
        self._display = display
        self._task = display.add_task("", total=None, visible=False)

    def begin(self, stage: str, total: int | None) -> None:
        """Draw a line for `stage`; without a total it only shows that something happens."""
        self._task = self._display.add_task(stage, total=total)

    def advance(self, steps: int = 1) -> None:
        """Move the stage's bar."""
        self._display.advance(self._task, steps)

    def end(self) -> None:
        """Fill the stage's bar and stop its clock."""
        task = next(task for task in self._display.tasks if task.id == self._task)
        total = task.total if task.total is not None else max(task.completed, 1)
        self._display.update(self._task, total=total, completed=total)
        self._display.stop_task(self._task)


@contextmanager
def progress_display(*, quiet: bool) -> Iterator[Listener]:
    """Show progress while the block runs; nothing when `quiet` or when stderr is no terminal."""
    if quiet or not sys.stderr.isatty():
        yield Silence()
        return
    columns = (
        SpinnerColumn(finished_text="[green]✓"),
        TextColumn("{task.description}"),
        BarColumn(bar_width=30),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as display:
        yield RichProgress(display)
