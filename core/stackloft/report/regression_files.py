"""The files of a regression: Figures 9 and 10 of Goñi, Purlis & Salvadori (2007) as picture and numbers.

===============================  =================================================
``regression.json``              everything
``samples.csv``                  every row with its relative error and density
``groups.csv``                   every group's figures
``figure_09_area_weight.*``      area against weight, with S = α₀·W^(2/3)
``figure_10_area_volume.*``      area against measured volume, with S = β₀·V^(2/3)
``volumes.png``                  estimated against measured volume
===============================  =================================================
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import BinaryIO

import numpy as np

from stackloft.report.charts import COLOURS, MARKERS, as_label, chart
from stackloft.report.csv_rows import write_rows
from stackloft.report.whole_file import whole_file
from stackloft.studies.regression import EXPONENT, GroupStatistics, Regression
from stackloft.studies.specimen_table import Specimen
from stackloft.studies.through_origin import OriginFit

_Reach = Callable[[Specimen], float]
_Fit = Callable[[GroupStatistics], OriginFit]


def write_regression(found: Regression, folder: Path) -> Iterator[Path]:
    """Write every file into the existing `folder`, each whole or not at all, and name it once it is there."""
    for name, fill in _files(found):
        with whole_file(folder / name) as stream:
            fill(stream)
        yield folder / name


def _files(found: Regression) -> Iterator[tuple[str, Callable[[BinaryIO], None]]]:
    yield "regression.json", partial(_json, found)
    yield "samples.csv", partial(_samples, found)
    yield "groups.csv", partial(_groups, found)
    for name, quantity, unit, reach, fit in _PLOTS:
        yield f"{name}.csv", partial(_fitted, found, f"{quantity}_{unit}", reach, fit)
        yield f"{name}.png", partial(_areas, found, f"{quantity}, {unit}", reach, fit)
    yield "volumes.png", partial(_volumes, found)


_PLOTS: tuple[tuple[str, str, str, _Reach, _Fit], ...] = (
    ("figure_09_area_weight", "weight", "g", lambda x: x.weight, lambda g: g.area_by_weight),
    ("figure_10_area_volume", "volume_measured", "cm3", lambda x: x.volume_measured,
     lambda g: g.area_by_volume),
)  # fmt: skip


def _json(found: Regression, stream: BinaryIO) -> None:
    stream.write((json.dumps(found.as_json(), indent=2, ensure_ascii=False) + "\n").encode())


def _samples(found: Regression, stream: BinaryIO) -> None:
    header = ("sample", "group", "weight_g", "volume_measured_cm3", "volume_estimated_cm3",
              "area_estimated_cm2", "relative_error_percent", "density_g_cm3")  # fmt: skip
    rows = [[*asdict(x).values(), x.relative_error, x.density] for x in found.specimens]
    write_rows(header, rows, stream)


def _groups(found: Regression, stream: BinaryIO) -> None:
    plain = ("group", "count", "mean_relative_error", "mare", "correlation", "density", "density_deviation")
    fit = ("coefficient", "standard_error", "r_squared", "r_squared_uncentred", "residual")
    header = [*plain, *(f"alpha0_{name}" for name in fit), *(f"beta0_{name}" for name in fit)]
    rows = [
        [
            *(getattr(group, name) for name in plain),
            *(getattr(line, name) for line in (group.area_by_weight, group.area_by_volume) for name in fit),
        ]
        for group in found.groups
    ]
    write_rows(header, rows, stream)


def _fitted(found: Regression, column: str, reach: _Reach, fit: _Fit, stream: BinaryIO) -> None:
    """Write each sample's place in the figure, and the fitted area beside it."""
    lines = {group.group: fit(group).coefficient for group in found.groups}
    rows = [
        [x.group, x.sample, reach(x), x.area_estimated, lines[x.group] * reach(x) ** EXPONENT]
        for x in found.specimens
    ]
    write_rows(("group", "sample", column, "area_cm2", "area_fitted_cm2"), rows, stream)


def _areas(found: Regression, label: str, reach: _Reach, fit: _Fit, stream: BinaryIO) -> None:
    """Draw area against weight or volume: samples as marks, a curve through the origin per group."""
    symbol = "W" if label.startswith("weight") else "V"
    with chart(stream) as (_, (axes,)):
        for number, group in enumerate(found.groups):
            members = found.members(group.group)
            x = [reach(member) for member in members]
            line = fit(group)
            colour = COLOURS[number % len(COLOURS)]
            told = "" if line.r_squared is None else f",  R² = {line.r_squared:.4f}"
            axes.plot(
                x,
                _area_of(members),
                MARKERS[number % len(MARKERS)],
                color=colour,
                label=as_label(group.group),
            )
            along = np.linspace(0.9 * min(x), 1.1 * max(x), 80)
            axes.plot(
                along, line.coefficient * along**EXPONENT, color=colour, linewidth=1.2,
                label=f"S = {line.coefficient:.4f} {symbol}$^{{2/3}}${told}",
            )  # fmt: skip
        axes.set_xlabel(label.replace("_", " ").replace("cm3", "cm³"))
        axes.set_ylabel("surface area, cm²")
        axes.legend(fontsize=7.5, frameon=False)


def _area_of(members: Sequence[Specimen]) -> list[float]:
    return [member.area_estimated for member in members]


def _volumes(found: Regression, stream: BinaryIO) -> None:
    """Draw estimated against measured volume, with the line on which they are equal."""
    with chart(stream) as (_, (axes,)):
        for number, group in enumerate(found.groups):
            members = found.members(group.group)
            told = "" if group.correlation is None else f",  r = {group.correlation:.4f}"
            axes.plot(
                [x.volume_measured for x in members], [x.volume_estimated for x in members],
                MARKERS[number % len(MARKERS)], color=COLOURS[number % len(COLOURS)],
                label=f"{as_label(group.group)}: mean RE {group.mean_relative_error:+.2f} %{told}",
            )  # fmt: skip
        reach = [x.volume_measured for x in found.specimens]
        axes.plot(
            [min(reach), max(reach)], [min(reach), max(reach)], color="0.5", linewidth=0.9, label="equal"
        )
        axes.set_xlabel("measured volume, cm³")
        axes.set_ylabel("estimated volume, cm³")
        axes.legend(fontsize=7.5, frameon=False)
