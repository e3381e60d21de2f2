"""The files of an accuracy study.

====================  =====================================================================
``accuracy.csv``      every method on every body at every value of every axis
``orders.csv``        the observed order of convergence beside the theoretical one
``summary.csv``       every method along every axis, over all bodies
``accuracy.json``     all of it
``heat_map.png``      |error| of volume and area at the finest value, bodies × methods
====================  =====================================================================
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.report.charts import as_label, chart
from stackloft.report.csv_rows import write_rows
from stackloft.report.whole_file import whole_file
from stackloft.studies.accuracy_table import Accuracy, AccuracyRow, ObservedOrder, Summary, finest

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_RANGE = (1e-4, 10.0)
"""%, the ends of the colour scale."""


def write_accuracy(found: Accuracy, folder: Path) -> Iterator[Path]:
    """Write every file into the existing `folder`, each whole or not at all, and name it once it is there."""
    for name, fill in _files(found):
        with whole_file(folder / name) as stream:
            fill(stream)
        yield folder / name


def _files(found: Accuracy) -> Iterator[tuple[str, Callable[[BinaryIO], None]]]:
    yield "accuracy.csv", partial(_table, AccuracyRow, found.rows)
    yield "orders.csv", partial(_table, ObservedOrder, found.orders)
    yield "summary.csv", partial(_table, Summary, found.summaries())
    yield "accuracy.json", partial(_json, found)
    yield "heat_map.png", partial(write_heat_map, found)


def _table(kind: type[Any], rows: Sequence[Any], stream: BinaryIO) -> None:
    names = [item.name for item in fields(kind)]
    write_rows(names, [[getattr(row, name) for name in names] for row in rows], stream)


def _json(found: Accuracy, stream: BinaryIO) -> None:
    stream.write((json.dumps(found.as_json(), indent=1, ensure_ascii=False) + "\n").encode())


def write_heat_map(found: Accuracy, stream: BinaryIO) -> None:
    """Draw |error| at the finest value of each axis, volume above area; × is a failure, white no figure."""
    last = [row for row in finest(found.rows) if row.applicable]
    columns = sorted(
        dict.fromkeys((row.axis, row.method) for row in last), key=lambda key: _axis_rank(found, key[0])
    )
    bodies = list(dict.fromkeys(row.body for row in last))
    size = (4.5 + 0.26 * len(columns), 2.2 + 0.36 * max(len(bodies), 4))
    with chart(stream, rows=2, size=size) as (figure, axes):
        for one, name in zip(axes, ("volume", "area"), strict=True):
            values, failed = _grid(last, columns, bodies, f"{name}_error")
            shown = np.log10(np.clip(values, *_RANGE))
            one.grid(visible=False)
            image = one.imshow(shown, aspect="auto", cmap="viridis_r", vmin=-4, vmax=1)
            rows, places = np.nonzero(failed)
            one.plot(places, rows, "x", color="#c8442b", markersize=4)
            _name_cells(one, columns, bodies, f"{name}: |error|, %")
            bar = figure.colorbar(image, ax=one, ticks=range(-4, 2), pad=0.01)
            bar.ax.set_yticklabels([f"{10.0**k:g} %" for k in range(-4, 2)], fontsize=7)


def _axis_rank(found: Accuracy, axis: str) -> int:
    return list(dict.fromkeys(row.axis for row in found.rows)).index(axis)


def _grid(
    rows: Sequence[AccuracyRow], columns: Sequence[tuple[str, str]], bodies: Sequence[str], name: str
) -> tuple[FloatArray, FloatArray]:
    """Return |error| and failures, (bodies, columns); nan where there is nothing to show."""
    values = np.full((len(bodies), len(columns)), np.nan)
    failed = np.zeros(values.shape)
    for row in rows:
        at = bodies.index(row.body), columns.index((row.axis, row.method))
        error = getattr(row, name)
        values[at] = np.nan if error is None else abs(error)
        failed[at] = row.failure is not None
    return values, failed


def _name_cells(axes: Axes, columns: Sequence[tuple[str, str]], bodies: Sequence[str], title: str) -> None:
    axes.set_xticks(range(len(columns)), [as_label(method) for _, method in columns], rotation=90, fontsize=7)
    axes.set_yticks(range(len(bodies)), [as_label(body) for body in bodies], fontsize=7)
    axes.set_title(title, fontsize=9, loc="left", pad=16)
    for axis in dict.fromkeys(axis for axis, _ in columns):
        mine = [number for number, (other, _) in enumerate(columns) if other == axis]
        axes.axvline(mine[-1] + 0.5, color="white", linewidth=2.0)
        axes.text(float(np.mean(mine)), -0.7, axis, ha="center", va="bottom", fontsize=8)
