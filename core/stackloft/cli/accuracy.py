"""``stackloft accuracy``."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from stackloft.cli.progress import progress_display
from stackloft.cli.screen import console
from stackloft.model.errors import UsageError
from stackloft.registry import find, nearest
from stackloft.report.whole_file import writable_folder
from stackloft.studies.accuracy import AccuracyRequest, study_accuracy
from stackloft.studies.accuracy_axes import AXES, FULL, QUICK
from stackloft.studies.accuracy_bodies import bodies_named
from stackloft.studies.accuracy_table import Accuracy, AccuracyRow


@dataclass(frozen=True, slots=True)
class Output:
    """What a person wants to be given."""

    folder: Path | None
    json: bool
    quiet: bool


def request_of(
    methods: Sequence[str], bodies: Sequence[str], axes: Sequence[str], *, quick: bool
) -> AccuracyRequest:
    """Return what the command line asks for; nothing named means all of it.

    Raises
    ------
    UsageError
        A body or an axis that is not there.
    PluginError
        A method that is not installed.
    """
    for axis in axes:
        if axis not in AXES:
            raise UsageError(f"no axis {axis!r}", where="--axis", fix=nearest(axis, list(AXES)))
    for method in methods:
        if method != "all":
            find("recipe", method)
    chosen = tuple(axis for axis in AXES if not axes or axis in axes)
    named = bodies_named(tuple(bodies))
    return AccuracyRequest(named, chosen, QUICK if quick else FULL, tuple(methods) or ("all",))


def run(request: AccuracyRequest, output: Output) -> None:
    """Run the study, write its files and show what it comes to.

    Raises
    ------
    StackloftError
        A file cannot be written.
    """
    folder = None if output.folder is None else writable_folder(output.folder)
    with progress_display(quiet=output.quiet) as progress:
        found = study_accuracy(request, progress=progress)
    files: list[Path] = []
    if folder is not None:
        from stackloft.report.accuracy_files import write_accuracy  # noqa: PLC0415 - only with --out

        files = list(write_accuracy(found, folder))
    if output.json:
        json.dump(found.as_json(), sys.stdout, indent=1, ensure_ascii=False, allow_nan=False)
        sys.stdout.write("\n")
    if not output.quiet:
        _show(found, files, stderr=output.json)


def _show(found: Accuracy, files: Sequence[Path], *, stderr: bool) -> None:
    screen = console(stderr=stderr)
    bodies = len({row.body for row in found.rows})
    title = f"{bodies} bodies · errors in % at the finest value of each axis, orders as medians over bodies"
    screen.print(Text(title, style="bold"))
    screen.print(Padding(_summaries(found), (0, 0, 1, 2), expand=False))
    expected = [row for row in found.rows if row.expected_volume_error is not None]
    if expected:
        screen.print(Text("Cavalieri on ellipsoids at mid-thickness: theory gives +1/(2m²)", style="bold"))
        screen.print(Padding(_expected(expected), (0, 0, 1, 2), expand=False))
    if found.failures():
        screen.print(Text("failures", style="bold yellow"))
        screen.print(Padding(_failures(found), (0, 0, 0, 2), expand=False))
    if files:
        screen.print(Text("files", style="bold"))
        for path in files:
            screen.print(Text(f"  {path}"), soft_wrap=True)


def _summaries(found: Accuracy) -> Table:
    table = _table(
        "method", "axis", "cases", "failed", "V rms", "V worst", "S rms", "S worst", "V order", "theory",
        "S order",
    )  # fmt: skip
    before = ""
    for line in found.summaries():
        if not line.measured and not line.failed:
            continue
        table.add_row(
            Text(line.method if line.method != before else ""), line.axis, str(line.measured),
            str(line.failed or ""),
            *(_error(x) for x in (line.volume_rms, line.volume_worst, line.area_rms, line.area_worst)),
            *(_order(x) for x in (line.volume_order, line.theory, line.area_order)),
        )  # fmt: skip
        before = line.method
    return table


def _expected(rows: Sequence[AccuracyRow]) -> Table:
    table = _table("body", "sections", "V error", "theory", "difference")
    for row in rows:
        seen, theory = row.volume_error, row.expected_volume_error
        if seen is not None and theory is not None:
            figures = (f"{seen:+.5f}", f"{theory:+.5f}", f"{seen - theory:+.1e}")
            table.add_row(Text(row.body), str(row.value), *figures)
    return table


def _failures(found: Accuracy) -> Table:
    table = _table("method", "reason", "cases", "for example")
    for (method, reason), rows in found.failures().items():
        first = rows[0]
        example = f"{first.body}, {first.axis} {first.value}"
        table.add_row(Text(method), Text(reason), str(len(rows)), Text(example))
    return table


def _table(*columns: str) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0))
    words = {"method", "axis", "body", "reason", "for example"}
    for column in columns:
        table.add_column(column, justify="left" if column in words else "right")
    return table


def _error(value: float | None) -> str:
    return "–" if value is None else f"{value:.4f}" if value >= 1e-4 else f"{value:.0e}"


def _order(value: float | None) -> str:
    return "–" if value is None else f"{value:.1f}"
