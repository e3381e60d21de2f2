"""The files of a study of convergence: Figures 6 to 8 of Goñi, Purlis & Salvadori (2007).

=========================  ====================================================================
``convergence.json``       everything
``figure_06_points.*``     volume and area against boundary points, as CSV and PNG
``figure_07_sections.*``   volume and area against sections
``figure_08_error.*``      relative error against the whole model, by points and by sections
=========================  ====================================================================
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from stackloft.report.charts import COLOURS, MARKERS, chart
from stackloft.report.csv_rows import write_rows
from stackloft.report.whole_file import whole_file
from stackloft.studies.convergence_table import Convergence, Model

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SMALLEST = 1e-5
"""%, the lower end of the error axis: below it nothing is measured."""
_COLUMNS = ("sections", "points", "volume", "area", "volume_error", "area_error", "failure")
_HEADER = ("sections", "points", "volume_mm3", "area_mm2", "volume_error_percent", "area_error_percent",
           "failure")  # fmt: skip
_Count = Callable[[Model], int]


def write_convergence(found: Convergence, folder: Path, tolerance: float | None = None) -> Iterator[Path]:
    """Write every file into the existing `folder`, each whole or not at all, and name it once it is there.

    Parameters
    ----------
    found : Convergence
    folder : Path
    tolerance : float, optional
        %, drawn into the error's figure.
    """
    for name, fill in _files(found, tolerance):
        with whole_file(folder / name) as stream:
            fill(stream)
        yield folder / name


def _files(found: Convergence, tolerance: float | None) -> Iterator[tuple[str, Callable[[BinaryIO], None]]]:
    yield "convergence.json", partial(_json, found, tolerance)
    sweeps = _sweeps(found)
    for name, label, rows, count in sweeps:
        yield f"{name}.csv", partial(_rows, rows)
        yield f"{name}.png", partial(_figures, rows, label, count)
    yield "figure_08_error.csv", partial(_rows, [row for _, _, rows, _ in sweeps for row in rows])
    yield "figure_08_error.png", partial(_errors, sweeps, tolerance)


def _sweeps(found: Convergence) -> list[tuple[str, str, Sequence[Model], _Count]]:
    by_sections = ("figure_07_sections", "sections", found.by_sections, _sections)
    if not found.by_points:
        return [by_sections]
    return [("figure_06_points", "boundary points per section", found.by_points, _points), by_sections]


def _sections(model: Model) -> int:
    return model.sections


def _points(model: Model) -> int:
    return model.points or 0


def _json(found: Convergence, tolerance: float | None, stream: BinaryIO) -> None:
    stream.write((json.dumps(found.as_json(tolerance), indent=2, ensure_ascii=False) + "\n").encode())


def _rows(rows: Sequence[Model], stream: BinaryIO) -> None:
    write_rows(_HEADER, [[getattr(row, name) for name in _COLUMNS] for row in rows], stream)


def _figures(rows: Sequence[Model], label: str, count: _Count, stream: BinaryIO) -> None:
    """Draw volume and area, each on its own axes."""
    with chart(stream, columns=2, size=(9.0, 3.8)) as (_, axes):
        for number, (name, unit, scale) in enumerate((("volume", "cm³", 1e3), ("area", "cm²", 1e2))):
            made = [(count(row), getattr(row, name)) for row in rows if getattr(row, name) is not None]
            axes[number].plot(
                [x for x, _ in made], [value / scale for _, value in made],
                color=COLOURS[number], marker=MARKERS[number], markersize=4, linewidth=1.2,
            )  # fmt: skip
            _count_axis(axes[number], label)
            axes[number].set_ylabel(f"{name}, {unit}")


def _errors(
    sweeps: Sequence[tuple[str, str, Sequence[Model], _Count]], tolerance: float | None, stream: BinaryIO
) -> None:
    """Draw the absolute relative errors, logarithmically, one axes for each sweep."""
    with chart(stream, columns=len(sweeps), size=(4.5 * len(sweeps), 3.8)) as (_, axes):
        for one, (_, label, rows, count) in zip(axes, sweeps, strict=True):
            for number, name in enumerate(("volume", "area")):
                errors = [(count(row), getattr(row, f"{name}_error")) for row in rows[:-1]]
                made = [(x, max(abs(error), _SMALLEST)) for x, error in errors if error is not None]
                one.plot(
                    [x for x, _ in made], [error for _, error in made], label=name,
                    color=COLOURS[number], marker=MARKERS[number], markersize=4, linewidth=1.2,
                )  # fmt: skip
            one.set_yscale("log")
            one.set_ylabel("|relative error|, %")
            if tolerance is not None:
                one.axhline(tolerance, color="0.4", linewidth=0.9, linestyle="--", label=f"{tolerance:g} %")
            _count_axis(one, label)
            one.legend(fontsize=8, frameon=False)


def _count_axis(axes: Axes, label: str) -> None:
    """Name the axis; points span two decades, so they are spread evenly by their logarithm."""
    axes.set_xlabel(label)
    axes.locator_params(axis="x", integer=True)
    if "points" in label:
        axes.set_xscale("log")
        ticks = (5, 9, 17, 33, 65, 129, 400)
        axes.set_xticks(ticks, [str(tick) for tick in ticks])
        axes.set_xticks([], minor=True)
