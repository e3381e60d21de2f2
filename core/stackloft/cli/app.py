"""The commands' signatures; what each does is imported when it runs."""

# ruff: noqa: PLC0415 - imports inside the commands keep `stackloft --help` quick

from __future__ import annotations

from typing import Annotated

import typer

from stackloft.cli import arguments as a
from stackloft.cli.guard import answering, guarded
from stackloft.cli.phantom_command import phantom_commands
from stackloft.cli.plugin_commands import plugin_commands
from stackloft.cli.study_commands import study_commands

app = typer.Typer(
    name="stackloft",
    help="Volume and surface area of irregular solids from slice photographs and scans.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(version("stackloft"))
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool,
        typer.Option(
            "--version", help="Print the version and leave.", callback=_print_version, is_eager=True
        ),
    ] = False,
) -> None:
    pass


@app.command()
@guarded
def measure(  # noqa: PLR0913, PLR0917 - one parameter per flag is how Typer declares them
    source: a.Source,
    out: a.Out = None,
    json: a.Json = False,
    quiet: a.Quiet = False,
    write: a.Write = None,
    figure_slice: a.FigureSlice = None,
    units: a.TableUnits = None,
    pixel_size: a.PixelSize = None,
    reference: a.ReferenceFlag = None,
    thickness: a.Thickness = None,
    positions: a.Positions = None,
    method: a.Method = None,
    points: a.Points = None,
    ends: a.Ends = None,
    height: a.Height = None,
    object: a.Object = None,  # noqa: A002 - the flag's own name
    axis: a.Axis = None,
    scale_uncertainty: a.ScaleUncertaintyFlag = None,
    keep_identifiers: a.KeepIdentifiers = False,
    align: a.Align = None,
    settings: a.Settings = None,
    recipe: a.RecipeFile = None,
    reader: a.Reader = None,
    segmenter: a.Segmenter = None,
) -> None:
    """Measure volume and surface area.

    Lengths are written 5.6mm, 0.021cm, 57.5um; a bare number is millimetres.
    """
    from stackloft.cli.measure import Output, request_of, run
    from stackloft.registry import parse_settings
    from stackloft.report.chosen_writer import split_settings

    flags = {
        "pixel_size": pixel_size,
        "reference": reference,
        "thickness": thickness,
        "positions": positions,
        "points": points,
        "ends": ends,
        "height": height,
        "object": object,
        "axis": axis,
        "scale_uncertainty": scale_uncertainty,
        "keep_identifiers": keep_identifiers or None,
        "align": align,
    }
    writers, own = split_settings(parse_settings(settings or ()))
    request = request_of(
        source, reader=reader, segmenter=segmenter, method=method, flags=flags, settings=own, recipe=recipe
    )
    run(request, Output(out, a.names_of(write), writers, json, quiet, units and units.value, figure_slice))


@app.command()
@guarded
def info(  # noqa: PLR0913, PLR0917 - one parameter per flag is how Typer declares them
    source: a.Source,
    json: a.Json = False,
    units: a.ShownUnits = a.Units.MM,
    pixel_size: a.PixelSize = None,
    reference: a.ReferenceFlag = None,
    thickness: a.Thickness = None,
    positions: a.Positions = None,
    scale_uncertainty: a.ScaleUncertaintyFlag = None,
    keep_identifiers: a.KeepIdentifiers = False,
    settings: a.Settings = None,
    reader: a.Reader = None,
) -> None:
    """Show what is read: order, sizes, positions, hazards; nothing is measured."""
    from stackloft.cli.info import run
    from stackloft.cli.measure import request_of
    from stackloft.registry import parse_settings

    flags = {
        "pixel_size": pixel_size,
        "reference": reference,
        "thickness": thickness,
        "positions": positions,
        "scale_uncertainty": scale_uncertainty,
        "keep_identifiers": keep_identifiers or None,
    }
    own = parse_settings(settings or ())
    request = request_of(source, reader=reader, method=None, flags=flags, settings=own)
    run(request, as_json=json, unit=units.value)


@app.command()
@guarded
def mesh(  # noqa: PLR0913, PLR0917 - one parameter per flag is how Typer declares them
    source: a.Source,
    out: a.MeshOut,
    mesher: a.Mesher = None,
    order: a.Order = None,
    max_element_size: a.MaxElementSize = None,
    quiet: a.Quiet = False,
    units: a.ShownUnits = a.Units.CM,
    pixel_size: a.PixelSize = None,
    reference: a.ReferenceFlag = None,
    thickness: a.Thickness = None,
    positions: a.Positions = None,
    method: a.Method = None,
    points: a.Points = None,
    ends: a.Ends = None,
    height: a.Height = None,
    object: a.Object = None,  # noqa: A002 - the flag's own name
    settings: a.Settings = None,
    recipe: a.RecipeFile = None,
    reader: a.Reader = None,
    segmenter: a.Segmenter = None,
) -> None:
    """Export the solid, or tetrahedra in it, for other programs; the format is the file's suffix."""
    from stackloft.cli.measure import request_of
    from stackloft.cli.mesh import MeshWish, mesher_settings, run
    from stackloft.registry import parse_settings
    from stackloft.report.chosen_writer import split_settings

    flags = {
        "pixel_size": pixel_size,
        "reference": reference,
        "thickness": thickness,
        "positions": positions,
        "points": points,
        "ends": ends,
        "height": height,
        "object": object,
    }
    writers, rest = split_settings(parse_settings(settings or ()))
    options, own = mesher_settings(rest, {"order": order, "max_element_size": max_element_size})
    request = request_of(
        source, reader=reader, segmenter=segmenter, method=method, flags=flags, settings=own, recipe=recipe
    )
    run(request, MeshWish(out, mesher, options, writers, quiet, units.value))


app.add_typer(phantom_commands)
app.add_typer(study_commands)
app.add_typer(plugin_commands, name="plugins")


@app.command()
@answering
def completion(shell: a.Shell) -> None:
    """Print the script that completes commands, flags, plug-ins and options in bash, zsh or fish.

    bash: add  eval "$(stackloft completion bash)"  to ~/.bashrc

    zsh: add  eval "$(stackloft completion zsh)"  to ~/.zshrc

    fish: stackloft completion fish > ~/.config/fish/completions/stackloft.fish
    """
    from stackloft.cli.completion.scripts import show

    show(shell)
