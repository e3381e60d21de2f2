"""``stackloft regress``."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from stackloft.cli.screen import console
from stackloft.report.whole_file import writable_folder
from stackloft.studies.regression import GroupStatistics, Regression, regress
from stackloft.studies.through_origin import OriginFit


def run(table: Path, out: Path | None, *, as_json: bool) -> None:
    """Print the statistics of `table`, and write its figures into `out`.

    Raises
    ------
    StackloftError
        The table is wrong (row and column are named), or a file cannot be written.
    """
    found = regress(table)
    files: list[Path] = []
    if out is not None:
        from stackloft.report.regression_files import write_regression  # noqa: PLC0415 - only with --out

        files = list(write_regression(found, writable_folder(out)))
    if as_json:
        json.dump(found.as_json(), sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
        sys.stdout.write("\n")
    _show(found, files, table.name, stderr=as_json)


def _show(found: Regression, files: list[Path], name: str, *, stderr: bool) -> None:
    screen = console(stderr=stderr)
    screen.print(Text(f"{name} · {len(found.specimens)} samples", style="bold"))
    screen.print(Padding(_errors(found), (0, 0, 1, 2), expand=False))
    screen.print(Text("through the origin; R² about the mean (the paper's), and uncentred", style="bold"))
    screen.print(Padding(_fits(found), (0, 0, 0, 2), expand=False))
    if files:
        screen.print(Text("files", style="bold"))
        for path in files:
            screen.print(Text(f"  {path}"), soft_wrap=True)


def _errors(found: Regression) -> Table:
    table = _table("group", "n", "mean RE %", "MARE %", "r", "density g/cm³")
    for group in found.groups:
        table.add_row(
            Text(group.group), str(group.count), f"{group.mean_relative_error:+.2f}", f"{group.mare:.2f}",
            "–" if group.correlation is None else f"{group.correlation:.4f}",
            f"{group.density:.4f} ± {group.density_deviation:.4f}",
        )  # fmt: skip
    return table


def _fits(found: Regression) -> Table:
    table = _table("group", "fit", "coefficient", "std. error", "R²", "R² uncentred")
    for group in found.groups:
        for name, fit in _lines(group):
            table.add_row(
                Text(group.group), name, f"{fit.coefficient:.4f}", f"{fit.standard_error:.4f}",
                "–" if fit.r_squared is None else f"{fit.r_squared:.4f}", f"{fit.r_squared_uncentred:.4f}",
            )  # fmt: skip
    return table


def _lines(group: GroupStatistics) -> tuple[tuple[str, OriginFit], ...]:
    return ("S = α₀ W^(2/3)", group.area_by_weight), ("S = β₀ V^(2/3)", group.area_by_volume)


def _table(*columns: str) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0))
    for column in columns:
        table.add_column(column, justify="left" if column in {"group", "fit"} else "right")
    return table
