"""The signatures of the commands that ask how good figures are: regress, convergence, accuracy."""

# ruff: noqa: PLC0415 - imports inside the commands keep `stackloft --help` quick

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stackloft.cli import arguments as a
from stackloft.cli.guard import answering, guarded

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
@answering
def regress(table: TableFile, out: a.Out = None, json: a.Json = False) -> None:
    """Compare estimated with measured volumes, and fit area to weight and volume."""
    from stackloft.cli.regress import run

    run(table, out, as_json=json)


Tolerance = Annotated[
    str | None,
    typer.Option("--tolerance", metavar="PERCENT", help="Say how many suffice for it, as in 0.5%."),
]


@study_commands.command()
@guarded
def convergence(  # noqa: PLR0913, PLR0917 - one parameter per flag is how Typer declares them
    source: a.Source,
    out: a.Out = None,
    json: a.Json = False,
    quiet: a.Quiet = False,
    tolerance: Tolerance = None,
    units: a.ShownUnits = a.Units.CM,
    pixel_size: a.PixelSize = None,
    thickness: a.Thickness = None,
    positions: a.Positions = None,
    method: a.Method = None,
    ends: a.Ends = None,
    height: a.Height = None,
    settings: a.Settings = None,
    reader: a.Reader = None,
) -> None:
    """Show how area and volume settle as boundary points and sections are added."""
    from stackloft.cli.convergence import Output, run
    from stackloft.cli.measure import request_of
    from stackloft.cli.percent import parse_percent
    from stackloft.registry import parse_settings

    flags = {
        "pixel_size": pixel_size,
        "thickness": thickness,
        "positions": positions,
        "ends": ends,
        "height": height,
    }
    own = parse_settings(settings or ())
    request = request_of(source, reader=reader, method=method, flags=flags, settings=own)
    percent = None if tolerance is None else parse_percent(tolerance, "--tolerance")
    run(request, Output(out, json, quiet, percent, units.value))


Bodies = Annotated[
    list[str] | None,
    typer.Option("--body", metavar="NAME", help="A body or phantom; may be repeated.  [default: all]"),
]
Axes = Annotated[
    str | None,
    typer.Option("--axis", metavar="NAME,…", help="sections, points, pixel, spacing, pose.  [default: all]"),
]
Quick = Annotated[bool, typer.Option("--quick", help="Two coarse values of each axis.")]
Methods = Annotated[str | None, typer.Option("--method", metavar="NAME,…", help="[default: all]")]


@study_commands.command()
@guarded
def accuracy(
    out: a.Out = None,
    json: a.Json = False,
    quiet: a.Quiet = False,
    quick: Quick = False,
    method: Methods = None,
    body: Bodies = None,
    axis: Axes = None,
) -> None:
    """Run every method on bodies whose volume and area are known: errors and orders of convergence."""
    from stackloft.cli.accuracy import Output, request_of, run

    request = request_of(a.names_of(method), body or (), a.names_of(axis), quick=quick)
    run(request, Output(out, json, quiet))
