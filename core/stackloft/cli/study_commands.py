"""The signatures of the commands that ask how good figures are: regress, convergence, accuracy."""

# ruff: noqa: PLC0415 - imports inside the commands keep `stackloft --help` quick

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stackloft.cli import arguments as a
from stackloft.cli.guard import guarded

study_commands = typer.Typer()

TableFile = Annotated[
    Path,
    typer.Argument(
        metavar="TABLE.csv",
        help="One specimen a row: sample, group, weight_g, volume_measured_cm3, volume_estimated_cm3,"
        " area_estimated_cm2.",
        show_default=False,
    ),
]


@study_commands.command()
@guarded
def regress(table: TableFile, out: a.Out = None, json: a.Json = False) -> None:
    """Compare estimated with measured volumes, and fit area to weight and volume."""
    from stackloft.cli.regress import run

    run(table, out, as_json=json)
