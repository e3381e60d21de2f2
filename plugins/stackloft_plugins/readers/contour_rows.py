"""Rows of a contour table: checked one by one, so that a message can name the line."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from stackloft.model.errors import InputError

REQUIRED = ("section", "z", "loop", "x", "y")
OPTIONAL = ("corner", "hole")

_FLAGS = {"0": False, "1": True, "": False, "false": False, "true": True}


@dataclass(slots=True)
class LoopRows:
    """The vertices of one loop as the file lists them."""

    first_line: int
    points: list[tuple[float, float]] = field(default_factory=list)
    corners: list[bool] = field(default_factory=list)
    hole: bool | None = None
    """None when the file does not say."""


@dataclass(slots=True)
class SectionRows:
    """The loops of one section as the file lists them."""

    z: float
    first_line: int
    loops: dict[str, LoopRows] = field(default_factory=dict)


@dataclass(slots=True)
class ContourTable:
    """A checked table."""

    sections: dict[str, SectionRows] = field(default_factory=dict)
    has_corners: bool = False


def looks_like_contours(text: str) -> bool:
    r"""Return whether the first line that is no comment is a contour table's header.

    Examples
    --------
    >>> looks_like_contours("# apple 4\nsection,z,loop,x,y,corner\n1,0,1,0,0,1")
    True
    >>> looks_like_contours("x,y\n1,2")
    False
    """
    for line in text.splitlines():
        if line.strip() and not line.lstrip().startswith("#"):
            return set(REQUIRED) <= set(_names(line.split(",")))
    return False


def parse_contours(lines: Iterable[str], where: str) -> ContourTable:
    """Return the table in `lines`: header ``section,z,loop,x,y[,corner][,hole]``, lengths in mm.

    Parameters
    ----------
    lines : iterable of str
        Lines of the file; those that begin with ``#`` and empty ones are passed over.
    where : str
        File name, for messages.

    Raises
    ------
    InputError
        A missing or unknown column, a value that is no finite number, or a section at two positions;
        file and line are named.

    Examples
    --------
    >>> table = parse_contours(["section,z,loop,x,y", "1,0,1,0,0", "1,0,1,2,0", "1,0,1,0,2"], "a.csv")
    >>> table.sections["1"].loops["1"].points
    [(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)]
    """
    rows = _rows(lines, where)
    first = next(rows, None)
    if first is None:
        raise InputError("contour table is empty", where=where, expected="section,z,loop,x,y")
    names = _header(*first, where)
    table = ContourTable(has_corners="corner" in names)
    for number, values in rows:
        at = f"{where}, line {number}"
        if len(values) != len(names):
            raise InputError(
                "wrong number of values",
                where=at,
                found=str(len(values)),
                expected=f"{len(names)}: {','.join(names)}",
            )
        _add(table, dict(zip(names, values, strict=True)), number, at)
    if not table.sections:
        raise InputError("contour table has no rows", where=where)
    return table


def _rows(lines: Iterable[str], where: str) -> Iterator[tuple[int, list[str]]]:
    """Yield line number and trimmed values of each line that says something."""
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            (values,) = csv.reader([line.rstrip("\r\n")], strict=True)
        except (csv.Error, ValueError) as error:
            raise InputError(
                "is no row of a CSV file", where=f"{where}, line {number}", found=str(error)
            ) from error
        yield number, [value.strip() for value in values]


def _names(values: list[str]) -> list[str]:
    return [value.strip().strip('"').lower().removeprefix("\ufeff") for value in values]


def _header(number: int, values: list[str], where: str) -> list[str]:
    names = _names(values)
    missing = [name for name in REQUIRED if name not in names]
    unknown = [name for name in names if name not in {*REQUIRED, *OPTIONAL}]
    if missing or unknown or len(set(names)) != len(names):
        problem = (
            f"column {missing[0]!r} is missing"
            if missing
            else f"unknown column {unknown[0]!r}"
            if unknown
            else "a column is named twice"
        )
        raise InputError(
            problem,
            where=f"{where}, line {number}",
            found=",".join(values),
            expected=f"{','.join(REQUIRED)}[,corner][,hole]",
        )
    return names


def _add(table: ContourTable, row: dict[str, str], line: int, at: str) -> None:
    z, x, y = (_number(row[name], name, at) for name in ("z", "x", "y"))
    section = table.sections.setdefault(row["section"], SectionRows(z, line))
    if z != section.z:
        raise InputError(
            f"section {row['section']} lies at two positions",
            where=at,
            found=f"z = {z:g} mm",
            expected=f"{section.z:g} mm as in line {section.first_line}",
        )
    loop = section.loops.setdefault(row["loop"], LoopRows(line))
    loop.points.append((x, y))
    loop.corners.append(_flag(row.get("corner", "0"), "corner", at))
    if "hole" in row:
        hole = _flag(row["hole"], "hole", at)
        if loop.hole not in {None, hole}:
            raise InputError(f"loop {row['loop']} is both hole and outline", where=at)
        loop.hole = hole


def _number(text: str, name: str, at: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{name} is no number", where=at, found=repr(text), expected="millimetres, as 12.5")
    return value


def _flag(text: str, name: str, at: str) -> bool:
    try:
        return _FLAGS[text.lower()]
    except KeyError:
        raise InputError(f"{name} is neither 0 nor 1", where=at, found=repr(text)) from None
