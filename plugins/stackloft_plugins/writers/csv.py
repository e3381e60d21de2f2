"""CSV: the sections' own figures as a table, units in the header."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass
from typing import BinaryIO, ClassVar

from stackloft.model.measurement import Result, SectionRow

HEADER = (
    "object",
    "section",
    "z [mm]",
    "area [mm^2]",
    "perimeter [mm]",
    "centroid x [mm]",
    "centroid y [mm]",
    "loops",
    "holes",
)
"""Column names of ``sections.csv``."""


@dataclass(frozen=True)
class CsvWriter:
    """Writes one row per section of every object (RFC 4180, UTF-8, numbers to full precision)."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Result,)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".csv",)

    def write(self, product: Result, stream: BinaryIO) -> None:
        """Write the sections of `product` to `stream`."""
        text = io.StringIO(newline="")
        table = csv.writer(text)
        table.writerow(HEADER)
        for measurement in product.objects:
            table.writerows(_cells(measurement.id, row) for row in measurement.sections)
        stream.write(text.getvalue().encode("utf-8"))


def _cells(object_id: int, row: SectionRow) -> tuple[int | str, ...]:
    lengths = (row.z, row.area, row.perimeter, *row.centroid)
    return (object_id, row.index, *map(_cell, lengths), row.loops, row.holes)


def _cell(value: float) -> str:
    """Return the shortest text that reads back to the same number; nothing for NaN."""
    return repr(float(value)) if math.isfinite(value) else ""
