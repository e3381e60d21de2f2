"""JSON: a run's result as ``measurement.json``, schema ``stackloft.measurement/1``.

The layout is fixed and documented in ``docs/measurement.md``; ``docs/measurement.schema.json`` checks it.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, BinaryIO, ClassVar

from stackloft.contracts.options import option
from stackloft.model.errors import OutputError
from stackloft.model.measurement import EndReport, Figure, Measurement, MethodRow, Result, SectionRow

SCHEMA = "stackloft.measurement/1"
"""Name and version of the layout."""


@dataclass(frozen=True)
class JsonWriter:
    """Writes a Result as one JSON document, UTF-8, numbers to full precision."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Result,)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".json",)

    indent: int = option(2, "spaces per level", ge=0, le=8)

    def write(self, product: Result, stream: BinaryIO) -> None:
        """Write `product` to `stream`.

        Raises
        ------
        OutputError
            A volume or an area is not a finite number: there is nothing true to write.
        """
        text = json.dumps(document(product), indent=self.indent, ensure_ascii=False, allow_nan=False)
        stream.write(text.encode("utf-8") + b"\n")


def document(result: Result) -> dict[str, Any]:
    """Return `result` in the layout of ``stackloft.measurement/1``, of plain JSON types alone.

    Raises
    ------
    OutputError
        A volume or an area is not a finite number.
    """
    return {
        "schema": SCHEMA,
        "source": plain(result.source),
        "objects": [_object(measurement) for measurement in result.objects],
        "warnings": [{"code": notice.code, "message": notice.message} for notice in result.warnings],
        "recipe": plain(result.recipe),
        "provenance": plain(result.provenance),
    }


def plain(value: Any) -> Any:
    """Return `value` in JSON's own types: numpy scalars as numbers, tuples as lists, NaN and ∞ as null.

    Examples
    --------
    >>> plain({"interval": (1.5, float("nan")), "points": 33})
    {'interval': [1.5, None], 'points': 33}
    """
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if hasattr(value, "tolist"):  # a numpy array or scalar
        return plain(value.tolist())
    if isinstance(value, (list, tuple, set, frozenset)):
        return [plain(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, (bool, int)) else str(value)


def _object(measurement: Measurement) -> dict[str, Any]:
    return {
        "id": measurement.id,
        "label": measurement.label,
        "volume": _figure(measurement.volume),
        "area": _figure(measurement.area),
        "methods": {name: _method(row) for name, row in measurement.methods.items()},
        "derived": {name: plain(measurement.derived.get(name)) for name in _DERIVED},
        "uncertainty_budget": [
            {key: plain(term.get(key)) for key in ("source", "volume", "area")}
            for term in measurement.uncertainty_budget
        ],
        "ends": [_end(end) for end in measurement.ends],
        "sections": [_section(row) for row in measurement.sections],
        "mesh": None
        if measurement.mesh is None
        else {key: plain(measurement.mesh.get(key)) for key in _MESH},
    }


_DERIVED = ("equivalent_diameter", "sphericity", "specific_surface", "density")
_MESH = ("order", "elements", "nodes", "min_scaled_jacobian", "inverted")


def _mesh(mesh: Mapping[str, Any] | None) -> dict[str, Any] | None:
    return None if mesh is None else {key: plain(mesh.get(key)) for key in _MESH}


def _figure(figure: Figure | None) -> dict[str, Any] | None:
    if figure is None:
        return None
    if not math.isfinite(figure.value):
        raise OutputError(
            "a figure is not a finite number",
            where=f"method {figure.method}",
            found=f"{figure.value} {figure.unit}",
            fix="please report it with the recipe that led to it",
        )
    return {
        "value": float(figure.value),
        "unit": figure.unit,
        "standard_uncertainty": plain(figure.standard_uncertainty),
        "interval95": _pair(figure.interval95),
        "method": figure.method,
    }


def _method(row: MethodRow) -> dict[str, Any]:
    return {
        "volume": _figure(row.volume),
        "area": _figure(row.area),
        "seconds": plain(row.seconds),
        "error": row.error,
    }


def _end(end: EndReport) -> dict[str, Any]:
    return {"kind": str(end.kind), "length": plain(end.length), "reason": end.reason}


def _section(row: SectionRow) -> dict[str, Any]:
    return {
        "index": row.index,
        "z": plain(row.z),
        "area": plain(row.area),
        "perimeter": plain(row.perimeter),
        "centroid": _pair(row.centroid),
        "loops": row.loops,
        "holes": row.holes,
    }


def _pair(pair: tuple[float, float] | None) -> list[float] | None:
    """Return both numbers, or None when one is not known."""
    numbers = plain(pair)
    return None if numbers is None or None in numbers else list(numbers)
