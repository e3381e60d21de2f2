"""The signatures of ``stackloft plugins …``."""

# ruff: noqa: PLC0415 - imports inside the commands keep `stackloft --help` quick

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stackloft.cli import arguments as a
from stackloft.cli.guard import guarded

plugin_commands = typer.Typer(
    help="What is installed, which options it has, whether it works, and how to add to it.",
    no_args_is_help=True,
)

Names = Annotated[
    list[str] | None,
    typer.Argument(metavar="[NAME…]", help="Only these plug-ins.  [default: all, and the machine as well]"),
]


@plugin_commands.command("list")
@guarded
def plugins_list(json: a.Json = False) -> None:
    """List every plug-in with its family, version, distribution, API version and state."""
    from stackloft.cli.plugin_list import show_list

    show_list(as_json=json)


@plugin_commands.command("show")
@guarded
def plugins_show(name: a.PluginName, json: a.Json = False) -> None:
    """Show what a plug-in does, its options with units, bounds, defaults and source, and an example."""
    from stackloft.cli.plugins import show

    show(name, as_json=json)


@plugin_commands.command("doctor")
@guarded
def plugins_doctor(names: Names = None, json: a.Json = False) -> None:
    """Load each plug-in in a process of its own; look for codecs, system libraries, kernels, rendering."""
    from stackloft.cli.doctor.report import run

    if not run(names or (), as_json=json):
        raise typer.Exit(1)


Subject = Annotated[
    str, typer.Argument(metavar="NAME|MODULE:CLASS", help="A plug-in, installed or not.", show_default=False)
]


@plugin_commands.command("check")
@guarded
def plugins_check(name: Subject, json: a.Json = False) -> None:
    """Run the conformance kit of a plug-in's family on it; exit status 1 when a check fails."""
    from stackloft.cli.plugin_check import run

    if not run(name, as_json=json):
        raise typer.Exit(1)


FamilyName = Annotated[
    str,
    typer.Argument(
        metavar="FAMILY",
        help="reader, segmenter, reconstructor, mesher, integrator, writer or recipe.",
        show_default=False,
    ),
]
NewName = Annotated[
    str, typer.Argument(metavar="NAME", help="Lower case with hyphens, as in acme-xct.", show_default=False)
]
NewFolder = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Folder to make.  [default: NAME, here]")
]


@plugin_commands.command("new")
@guarded
def plugins_new(family: FamilyName, name: NewName, out: NewFolder = None) -> None:
    """Begin a plug-in: a package with a working plug-in, its entry point, tests and README."""
    from stackloft.cli.plugin_new import run

    run(family, name, out)
