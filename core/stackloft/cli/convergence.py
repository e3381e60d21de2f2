"""``stackloft convergence``."""

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
from stackloft.cli.units import in_unit
from stackloft.model.errors import UsageError
from stackloft.pipeline.request import MeasureRequest
from stackloft.report.whole_file import writable_folder
from stackloft.studies.convergence import study_convergence
from stackloft.studies.convergence_table import Convergence, Model


@dataclass(frozen=True, slots=True)
class Output:
    """What a person wants to be given."""

    folder: Path | None
    json: bool
    quiet: bool
    tolerance: float | None
    """%"""
    unit: str


def run(request: MeasureRequest, output: Output) -> None:
    """Run the study, write its files and show how the figures settle.

    Raises
    ------
    StackloftError
        The source cannot be measured, the request makes no sense, or a file cannot be written.
    """
    folder = _folder(output, request.source)
    with progress_display(quiet=output.quiet) as progress:
        found = study_convergence(request, progress=progress)
    files: list[Path] = []
    if folder is not None:
        from stackloft.report.convergence_files import write_convergence  # noqa: PLC0415 - only with --out

        files = list(write_convergence(found, folder, output.tolerance))
    if output.json:
        json.dump(found.as_json(output.tolerance), sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
        sys.stdout.write("\n")
    if not output.quiet:
        _show(found, files, output)
    elif output.tolerance is not None and not output.json:
        console().print(*_answers(found, output.tolerance), sep="\n")


def _folder(output: Output, source: Path) -> Path | None:
    if output.folder is None:
        return None
    if output.folder.resolve() == source.resolve():
        raise UsageError("is the source itself", where=f"--out {output.folder}", fix="give another folder")
    return writable_folder(output.folder)


def _show(found: Convergence, files: Sequence[Path], output: Output) -> None:
    screen = console(stderr=output.json)
    whole = found.reference
    told = f"{whole.sections} sections" + (f", {whole.points} points" if whole.points else "")
    title = f"{Path(found.source).name} · method {found.method} · error against {told}"
    screen.print(Text(title, style="bold"))
    for name, rows in (("points", found.by_points), ("sections", found.by_sections)):
        if rows:
            screen.print(Padding(_table(name, rows, output), (0, 0, 1, 2), expand=False))
    if output.tolerance is not None:
        screen.print(*_answers(found, output.tolerance), sep="\n", style="bold green")
    for notice in found.warnings:
        screen.print(Text(f"{notice.code}: {notice.message}", style="yellow"))
    if files:
        screen.print(Text("files", style="bold"))
        for path in files:
            screen.print(Text(f"  {path}"), soft_wrap=True)


def _table(name: str, rows: Sequence[Model], output: Output) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0))
    for column in (name, "volume", "area", "volume error %", "area error %"):
        table.add_column(column, justify="right")
    for row in rows:
        count = str(getattr(row, name))
        if row.failure is not None:
            table.add_row(count, Text(row.failure, style="red"))
            continue
        errors = (row.volume_error, row.area_error)
        style = "green" if output.tolerance is not None and row.within(output.tolerance) else ""
        table.add_row(
            count, _figure(row.volume, output.unit, 3), _figure(row.area, output.unit, 2),
            *("–" if error is None else f"{error:+.4f}" for error in errors), style=style,
        )  # fmt: skip
    return table


def _figure(value: float | None, unit: str, power: int) -> str:
    return "–" if value is None else in_unit(value, unit, power)


def _answers(found: Convergence, tolerance: float) -> list[str]:
    """Return what suffices, a line for points and one for sections."""
    points, sections = found.suffices(tolerance)
    counts = [("sections", sections, found.reference.sections)]
    if found.reference.points:
        counts.insert(0, ("points per section", points, found.reference.points))
    return [
        f"{count} {name} suffice for ±{tolerance:g} %"
        if count is not None
        else f"no fewer than all {whole} {name} stay within ±{tolerance:g} %"
        for name, count, whole in counts
    ]
