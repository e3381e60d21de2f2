"""``stackloft measure``."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from stackloft.cli.progress import progress_display
from stackloft.cli.result_table import quiet_lines, show_result
from stackloft.cli.screen import console
from stackloft.contracts.sink import Sink
from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.errors import UsageError
from stackloft.pipeline.every_object import measure_objects
from stackloft.pipeline.outcome import Outcome
from stackloft.pipeline.recipe_file import load_recipe
from stackloft.pipeline.request import MeasureRequest
from stackloft.report.chosen_writer import ChosenWriter, solid_writers
from stackloft.report.figure_sink import FigureSink
from stackloft.report.run_folder import RunFolder
from stackloft.report.thumbnails import ThumbnailSink
from stackloft.report.whole_file import writable_folder


def request_of(
    source: Path,
    *,
    reader: str | None,
    method: str | None,
    flags: Mapping[str, Any],
    settings: Mapping[str, Mapping[str, Any]],
    recipe: Path | None = None,
    segmenter: str | None = None,
) -> MeasureRequest:
    """Return the request that the command line makes; what it says wins over the recipe file.

    Parameters
    ----------
    source : Path
        File or folder.
    reader, method : str, optional
        By name.
    flags : mapping
        General flags by option name, as text; None is left out.
    settings : mapping
        What ``--set`` said, by plug-in.
    recipe : Path, optional
        A ``recipe.toml``.
    segmenter : str, optional
        By name.
    """
    base = MeasureRequest(source) if recipe is None else load_recipe(recipe, source)
    return replace(
        base,
        reader=reader or base.reader,
        segmenter=segmenter or base.segmenter,
        method=method or base.method,
        shared={name: value for name, value in flags.items() if value is not None},
        settings=settings,
    )


@dataclass(frozen=True, slots=True)
class Output:
    """What a person wants to be given."""

    folder: Path | None
    solids: tuple[str, ...]
    """Writers of the solid, by name."""
    writer_settings: Mapping[str, Mapping[str, Any]]
    json: bool
    quiet: bool
    unit: str | None
    """Unit of the table; None: what ``stack.toml`` says, or cm."""
    figure_slice: str | None = None
    """Number or name of the slice that is shown step by step; None: the largest section."""


def run(request: MeasureRequest, output: Output) -> None:
    """Measure, write the files asked for, and show the figures.

    Raises
    ------
    StackloftError
        The source cannot be measured, the request makes no sense, or a file cannot be written.
    """
    folder = _folder(output, request.source)
    with progress_display(quiet=output.quiet) as progress:
        outcome = measure_objects(request, progress=progress, sinks=_sinks(output))
        files: list[Path] = []
        if folder is not None:
            progress.begin("write", None)
            for path in folder.write(outcome):
                files.append(path)
                progress.advance()
            progress.end()
    _show(outcome, files, output, output.unit or _unit_of(request.source))


def _folder(output: Output, source: Path) -> RunFolder | None:
    """Return where the files go, made and proved writable before anything is measured."""
    if output.folder is not None:
        if output.folder.resolve() == source.resolve():
            raise UsageError(
                "is the source itself, and the overview would be its next slice",
                where=f"--out {output.folder}",
                fix="give another folder",
            )
        writers = solid_writers(output.solids, output.writer_settings)
        return RunFolder(writable_folder(output.folder), writers)
    for flag, given in (("--write", output.solids), ("--figure-slice", output.figure_slice)):
        if given:
            raise UsageError("needs a folder", where=flag, fix="give --out DIR as well")
    return None


def _sinks(output: Output) -> list[Sink]:
    """Return what keeps pictures of the slices for the folder; nothing without one."""
    return [] if output.folder is None else [ThumbnailSink(), FigureSink(output.figure_slice)]


def _unit_of(source: Path) -> str:
    """Return the unit that the source's folder asks for, cm when it asks for none."""
    return load_stack_file(source if source.is_dir() else source.parent).units or "cm"


def _show(outcome: Outcome, files: list[Path], output: Output, unit: str) -> None:
    result = outcome.result
    if output.json:
        ChosenWriter.of("json").write(result, sys.stdout.buffer)
        sys.stdout.buffer.flush()
    if not output.quiet:
        show_result(console(stderr=output.json), result, files, unit)
        return
    if not output.json:
        print(*quiet_lines(result, unit), sep="\n")  # noqa: T201 - the command's own output
    for notice in result.warnings:
        print(f"stackloft: {notice.code}: {notice.message}", file=sys.stderr)  # noqa: T201
