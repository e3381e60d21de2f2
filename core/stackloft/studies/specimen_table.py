"""A table of specimens: measured weight and volume, estimated volume and area.

::

    # comment
    sample,group,weight_g,volume_measured_cm3,volume_estimated_cm3,area_estimated_cm2
    GS1,Granny Smith,227.4,295,289.37,221.29

Commas, semicolons or tabs between the cells; with semicolons or tabs a decimal comma is understood. A byte
order mark, other columns, empty lines and lines that begin with ``#`` are skipped.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from stackloft.model.errors import InputError
from stackloft.studies.table_header import Column, find_columns

ALL = "all"
"""The group's name when the table has no column for it."""

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


@dataclass(frozen=True, slots=True)
class Specimen:
    """One row."""

    sample: str
    group: str
    weight: float
    """g"""
    volume_measured: float
    """cm³"""
    volume_estimated: float
    """cm³"""
    area_estimated: float
    """cm²"""

    @property
    def relative_error(self) -> float:
        """(estimated − measured)/measured volume, %."""
        return (self.volume_estimated / self.volume_measured - 1.0) * 100.0

    @property
    def density(self) -> float:
        """Weight over measured volume, g/cm³."""
        return self.weight / self.volume_measured


def read_table(path: Path) -> tuple[Specimen, ...]:
    r"""Return the specimens in the file's order.

    Raises
    ------
    InputError
        The file cannot be read, is empty, or a row or column is wrong: the message names both.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "t.csv"
    >>> _ = path.write_text("sample;weight (kg);volume_measured_ml;volume_cm3;area_cm2\n"
    ...                     "a;0,2274;295;289,37;221,29\nb;0,2427;320;315,88;233,38\n")
    >>> round(read_table(path)[0].weight, 6)
    227.4
    """
    return parse_table(_text(path), str(path))


def parse_table(text: str, where: str = "table") -> tuple[Specimen, ...]:
    """Return the specimens of a table given as text; `where` names it in messages."""
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip(" ,;\t\r")]
    lines = [(n, line) for n, line in lines if not line.lstrip(' "').startswith("#")]
    if not lines:
        raise InputError("the table is empty", where=where, expected="a header and rows below it")
    delimiter = _delimiter(lines[0][1])
    rows = list(_cells(lines, delimiter, where))
    (first, header), body = rows[0], rows[1:]
    columns = find_columns(header, f"{where}, row {first}")
    if not body:
        raise InputError("the table has a header and no rows", where=where)
    found = [(n, _specimen(cells, header, columns, f"{where}, row {n}", delimiter)) for n, cells in body]
    _check_samples(found, where)
    return tuple(specimen for _, specimen in found)


def _text(path: Path) -> str:
    try:
        raw = path.read_bytes()
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise InputError(f"the table cannot be read: {reason}", where=str(path)) from error
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        row = raw[: error.start].count(b"\n") + 1
        raise InputError(
            "is no UTF-8 text", where=f"{path}, row {row}", fix="save it as CSV in UTF-8"
        ) from error
    if "\0" in text:
        raise InputError("is no text table", where=str(path), fix="save it as CSV in UTF-8")
    return text


def _delimiter(header: str) -> str:
    return max(",;\t", key=header.count)


def _cells(lines: list[tuple[int, str]], delimiter: str, where: str) -> Iterator[tuple[int, list[str]]]:
    """Yield row number and cells; a row is one line, for no cell here has reason to be longer."""
    for number, line in lines:
        try:
            (cells,) = csv.reader([line], delimiter=delimiter, strict=True, skipinitialspace=True)
        except csv.Error as error:
            raise InputError(
                "is no CSV row", where=f"{where}, row {number}", found=str(error), fix="check the quotes"
            ) from error
        yield number, [cell.strip() for cell in cells]


def _specimen(
    cells: list[str], header: list[str], columns: Mapping[str, Column], where: str, delimiter: str
) -> Specimen:
    if len(cells) > len(header) and any(cells[len(header) :]):
        hint = " (decimal commas need semicolons between the cells)" if delimiter == "," else ""
        raise InputError(
            f"more cells than the header has columns{hint}",
            where=where, found=f"{len(cells)} cells", expected=f"{len(header)}",
        )  # fmt: skip
    padded = cells + [""] * (len(header) - len(cells))
    values = {
        name: _number(padded[column.index], column, where, delimiter) * column.factor
        for name, column in columns.items()
        if name not in {"sample", "group"}
    }
    names = {name: _name(padded, columns[name], where) for name in ("sample", "group") if name in columns}
    return Specimen(names.get("sample", where.rpartition(" ")[2]), names.get("group", ALL), **values)


def _name(cells: list[str], column: Column, where: str) -> str:
    if not cells[column.index]:
        raise InputError("the cell is empty", where=f"{where}, column {column.header!r}")
    return cells[column.index]


def _number(cell: str, column: Column, where: str, delimiter: str) -> float:
    at = f"{where}, column {column.header!r}"
    if not cell:
        raise InputError("the cell is empty", where=at, expected="a positive number")
    text = cell.replace(",", ".") if delimiter != "," and cell.count(",") == 1 and "." not in cell else cell
    if not _NUMBER.fullmatch(text):
        fix = None
        if "," in cell:
            fix = "write a point before the decimals and nothing between thousands"
        raise InputError("not a number", where=at, found=repr(cell), expected="for example 227.4", fix=fix)
    value = float(text)
    if not math.isfinite(value) or value <= 0.0:
        raise InputError("must be a positive number", where=at, found=cell)
    return value


def _check_samples(rows: list[tuple[int, Specimen]], where: str) -> None:
    """Raise InputError when a sample stands there twice or a group has one row alone."""
    seen: dict[tuple[str, str], int] = {}
    groups: dict[str, list[int]] = {}
    for number, specimen in rows:
        key = (specimen.group, specimen.sample)
        if key in seen:
            raise InputError(
                f"sample {specimen.sample!r} is there twice", where=f"{where}, row {number}, column 'sample'",
                found=f"already in row {seen[key]}", fix="leave one out or name it otherwise",
            )  # fmt: skip
        seen[key] = number
        groups.setdefault(specimen.group, []).append(number)
    for group, numbers in groups.items():
        if len(numbers) == 1:
            raise InputError(
                f"group {group!r} has one row alone", where=f"{where}, row {numbers[0]}, column 'group'",
                expected="at least 2 rows in every group", fix="check the group's spelling",
            )  # fmt: skip
