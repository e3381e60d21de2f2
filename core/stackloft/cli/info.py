"""``stackloft info``: what was read, before anything is measured."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rich.table import Table
from rich.text import Text

from stackloft.cli.screen import console
from stackloft.cli.units import length
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack
from stackloft.model.notices import Notice
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import Hints, SliceStack
from stackloft.model.tri_mesh import TriMesh
from stackloft.pipeline.layers import Place, check_addresses, options_at
from stackloft.pipeline.request import MeasureRequest
from stackloft.pipeline.workbench import guarded
from stackloft.registry import choose_reader, instantiate

SCHEMA = "stackloft.info/1"


def run(request: MeasureRequest, *, as_json: bool, unit: str) -> None:
    """Print what the reader found at ``request.source``.

    Raises
    ------
    StackloftError
        The source cannot be read, or an option is not the reader's.
    """
    reader = choose_reader(request.source, request.reader)
    place = Place(reader)
    check_addresses([place], request)
    product = guarded(reader, instantiate(reader, options_at(place, request)).read, request.source)
    facts = {"schema": SCHEMA, "path": str(request.source), "reader": reader.name, **describe(product)}
    if as_json:
        json.dump(facts, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
        sys.stdout.write("\n")
        return
    console().print(_table(facts, unit))


def describe(product: Any) -> dict[str, Any]:
    """Return the facts about a reader's product, in JSON's types; lengths in mm."""
    stack = product.stack if isinstance(product, Segmentation) else product
    facts: dict[str, Any] = {"product": type(product).__name__}
    if isinstance(stack, SliceStack):
        facts |= _slices(stack)
    if isinstance(stack, ContourStack):
        facts |= _contours(stack)
    if isinstance(stack, TriMesh):
        facts |= {"vertices": len(stack.vertices), "triangles": len(stack.faces), "hazards": []}
    return facts


def _slices(stack: SliceStack) -> dict[str, Any]:
    rows, columns = stack.shape
    return {
        "kind": str(stack.kind),
        "slices": len(stack),
        "order": list(stack.names),
        "positions": stack.positions.tolist(),
        "pitch": _range(np.diff(stack.positions)),
        "thickness": None if stack.thickness is None else _range(stack.thickness),
        "pixels": [rows, columns],
        "affine": stack.affine.tolist(),
        "pixel_size": {"row": _range(stack.pixel_spacing[:, 0]), "column": _range(stack.pixel_spacing[:, 1])},
        "provenance": dict(stack.provenance),
        "hints": _hints(stack.hints),
        "hazards": _hazards(stack.notices),
    }


def _contours(stack: ContourStack) -> dict[str, Any]:
    return {
        "kind": str(stack.kind),
        "slices": len(stack),
        "order": [section.name for section in stack.sections],
        "positions": stack.positions.tolist(),
        "pitch": _range(np.diff(stack.positions)),
        "thickness": None if stack.thickness is None else [stack.thickness, stack.thickness],
        "affine": stack.affine.tolist(),
        "loops": [len(section.loops) for section in stack.sections],
        "exact": stack.exact,
        "provenance": dict(stack.provenance),
        "hints": _hints(stack.hints),
        "hazards": _hazards(stack.notices),
    }


def _range(values: FloatArray) -> list[float] | None:
    """Return least and greatest; None of nothing."""
    return [float(values.min()), float(values.max())] if len(values) else None


def _hints(hints: Hints) -> dict[str, Any]:
    said = {
        "ends": None if hints.ends is None else [str(end) for end in hints.ends],
        "height": hints.height,
        "background": hints.background,
        "specimen": hints.specimen,
        "measured_weight": hints.measured_weight,
        "measured_volume": hints.measured_volume,
        "slices": {
            str(number): {key: str(value) for key, value in item.items()}
            for number, item in hints.slices.items()
        },
    }
    return {key: value for key, value in said.items() if value}


def _hazards(notices: Sequence[Notice]) -> list[dict[str, str]]:
    return [{"code": notice.code, "message": notice.message} for notice in notices]


def _table(facts: dict[str, Any], unit: str) -> Table:
    table = Table.grid(padding=(0, 2))
    for name, value in _lines(facts, unit):
        table.add_row(name, Text(value))
    for hazard in facts["hazards"]:
        table.add_row("hazard", Text(f"{hazard['code']}: {hazard['message']}", style="yellow"))
    if not facts["hazards"]:
        table.add_row("hazards", "none seen")
    return table


def _lines(facts: dict[str, Any], unit: str) -> list[tuple[str, str]]:
    lines = [("source", Path(facts["path"]).name), ("reader", facts["reader"]), ("gives", facts["product"])]
    if "slices" in facts:
        lines += [
            ("slices", f"{facts['slices']} ({facts['kind']})"),
            ("order", _between(facts["order"])),
            ("positions", _lengths([facts["positions"][0], facts["positions"][-1]], unit, " to ")),
            ("pitch", _lengths(facts["pitch"], unit)),
        ]
    if "affine" in facts and facts["affine"] != np.eye(4).tolist():
        lines.append(("in space", _in_space(np.array(facts["affine"]))))
    if facts.get("thickness"):
        lines.append(("thickness", _lengths(facts["thickness"], unit)))
    if "pixels" in facts:
        rows, columns = facts["pixels"]
        across, down = facts["pixel_size"]["column"], facts["pixel_size"]["row"]
        size = (
            _lengths(across, unit) if across == down else f"{_lengths(across, unit)} × {_lengths(down, unit)}"
        )
        lines += [("picture", f"{columns} × {rows} pixels"), ("pixel size", size)]
    if "loops" in facts:
        lines.append(("loops", " ".join(str(count) for count in facts["loops"])))
    if "triangles" in facts:
        lines.append(("surface", f"{facts['triangles']} triangles, {facts['vertices']} vertices"))
    sources = facts.get("provenance", {})
    lines = [(name, f"{text} ({sources[name]})" if name in sources else text) for name, text in lines]
    lines += [(name, text) for name, text in sources.items() if name not in dict(lines)]
    lines += [(key.replace("_", " "), _said(value)) for key, value in facts.get("hints", {}).items()]
    return lines


def _in_space(affine: FloatArray) -> str:
    """Return the directions of columns, rows and slices in patient space, and where the stack's origin is."""
    named = zip(("columns", "rows", "slices", "origin"), affine[:3].T, strict=True)
    return "; ".join(f"{name} {', '.join(f'{x:.4g}' for x in column)}" for name, column in named)


def _between(names: Sequence[str]) -> str:
    return ", ".join(names) if len(names) <= 6 else f"{', '.join(names[:3])} … {', '.join(names[-2:])}"


def _lengths(pair: Sequence[float] | None, unit: str, joint: str = " … ") -> str:
    if pair is None:
        return "not defined by one slice"
    low, high = (length(value, unit) for value in pair)
    return low if low == high and joint == " … " else f"{low}{joint}{high}"


def _said(value: Any) -> str:
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)
