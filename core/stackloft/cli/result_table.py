"""A result as a person reads it at a glance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from stackloft.cli.units import in_unit, significant, with_uncertainty
from stackloft.model.measurement import EndReport, Figure, Measurement, Result

_PLACES = ("first", "last")
_ROUGH = 3
"""Significant digits of a guess."""


def show_result(console: Console, result: Result, files: Sequence[Path], unit: str) -> None:
    """Print `result` in `unit` with its warnings and the files written."""
    for measurement in result.objects:
        console.print(Text(_heading(result, measurement), style="bold"))
        console.print(Padding(_body(measurement, unit), (0, 0, 0, 2), expand=False))
    if result.warnings:
        console.print(Text("warnings", style="bold yellow"))
        console.print(Padding(_warnings(result), (0, 0, 0, 2), expand=False))
    if files:
        console.print(Text("files", style="bold"))
        for path in files:
            console.print(Text(f"  {path}"), soft_wrap=True)


def quiet_lines(result: Result, unit: str) -> Iterator[str]:
    """Return the two figures of each object, one a line."""
    for measurement in result.objects:
        yield f"volume {_figure(measurement.volume, unit, 3)}"
        yield f"area {_figure(measurement.area, unit, 2)}"


def _heading(result: Result, measurement: Measurement) -> str:
    name = Path(result.source.get("path", "")).name
    sections = f"{len(measurement.sections)} sections"
    label = [measurement.label] if measurement.label else []
    number = [f"object {measurement.id}"] if len(result.objects) > 1 else []
    return " · ".join([name, *number, *label, sections, f"method {measurement.volume.method}"])


def _body(measurement: Measurement, unit: str) -> Group:
    parts: list[RenderableType] = [_figures(measurement, unit)]
    if measurement.ends:
        parts.append(_ends(measurement.ends, unit))
    if len(measurement.methods) > 1:
        parts.append(_methods(measurement, unit))
    return Group(*parts)


def _figures(measurement: Measurement, unit: str) -> Table:
    table = Table.grid(padding=(0, 2))
    table.add_row("volume", Text(_figure(measurement.volume, unit, 3), style="bold green"))
    table.add_row("area", Text(_figure(measurement.area, unit, 2), style="bold green"))
    diameter = measurement.derived.get("equivalent_diameter")
    sphericity = measurement.derived.get("sphericity")
    density = measurement.derived.get("density")
    if diameter is not None:
        table.add_row("equivalent diameter", in_unit(diameter, unit, 1))
    if sphericity is not None:
        table.add_row("sphericity", significant(sphericity, 4))
    if density is not None:
        table.add_row("density", f"{significant(density, 4)} g/cm³")
    return table


def _figure(figure: Figure | None, unit: str, power: int) -> str:
    if figure is None:
        return "not given by this method"
    return with_uncertainty(figure.value, figure.standard_uncertainty, unit, power)


def _ends(ends: Sequence[EndReport], unit: str) -> Table:
    table = Table.grid(padding=(0, 2))
    for place, end in zip(_PLACES, ends, strict=False):
        beyond = f", {in_unit(end.length, unit, 1, _ROUGH)} beyond the section" if end.length else ""
        table.add_row(f"{place} end", Text(f"{end.kind}{beyond}; {_certainty(end, unit)}"))
    return table


def _certainty(end: EndReport, unit: str) -> str:
    """Return why the end was closed so, or what a guess may cost (its warning says why)."""
    if not end.guessed:
        return end.reason
    if end.volume_effect is None or end.area_effect is None:
        return f"guessed: {end.reason}"
    volume = in_unit(abs(end.volume_effect), unit, 3, _ROUGH)
    area = in_unit(abs(end.area_effect), unit, 2, _ROUGH)
    return f"guessed, ± {volume}, ± {area}"


def _methods(measurement: Measurement, unit: str) -> Table:
    table = Table("method", "volume", "area", "seconds", box=None, padding=(0, 2, 0, 0))
    for name, row in measurement.methods.items():
        if row.error is not None:
            table.add_row(name, Text(row.error, style="red"), "", "")
            continue
        volume, area = _figure(row.volume, unit, 3), _figure(row.area, unit, 2)
        table.add_row(name, volume, area, f"{row.seconds:.3f}")
    return table


def _warnings(result: Result) -> Table:
    table = Table.grid(padding=(0, 2))
    for notice in result.warnings:
        table.add_row(Text(notice.code, style="yellow"), Text(notice.message))
    return table
