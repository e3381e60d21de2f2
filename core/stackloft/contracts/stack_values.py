"""How values are written in ``stack.toml``; what cannot be read is a ValueError, as pydantic gathers it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stackloft.model.ends import End
from stackloft.model.errors import StackloftError
from stackloft.model.lengths import MILLIMETRES, parse_length, parse_lengths
from stackloft.model.reference import Reference, ReferenceKind

GRAMS = {"g": 1.0, "kg": 1e3, "mg": 1e-3, "oz": 28.349523125, "lb": 453.59237}
"""Grams in one unit."""

CUBIC_MILLIMETRES = {
    "ml": 1e3,
    "l": 1e6,
    "cc": 1e3,
    "ul": 1.0,
    **{f"{unit}{power}": mm**3 for unit, mm in MILLIMETRES.items() for power in ("3", "^3", "³")},
}
"""mm³ in one unit (lower case)."""

_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S*)\s*")


def length_of(value: Any) -> float:
    """Return a length in mm."""
    try:
        return parse_length(value)
    except StackloftError as error:
        raise ValueError(_reason(error)) from error


def lengths_of(value: Any) -> tuple[float, ...]:
    """Return lengths in mm, from text with commas or from a list."""
    if not isinstance(value, (str, list)):
        raise ValueError('not a list of lengths, as "0,5.6,11.1mm"')  # noqa: TRY004 - pydantic gathers ValueError
    try:
        return parse_lengths(value) if isinstance(value, str) else tuple(parse_length(item) for item in value)
    except StackloftError as error:
        raise ValueError(_reason(error)) from error


def reference_of(value: Any) -> Reference:
    """Return a reference object."""
    try:
        return Reference.parse(str(value))
    except StackloftError as error:
        raise ValueError(_reason(error)) from error


def fiducials_of(value: Any) -> Reference:
    """Return a fiducial mark."""
    mark = reference_of(value)
    if mark.kind is not ReferenceKind.DISC:
        raise ValueError("fiducial marks are discs, as disc:8mm")
    return mark


def ends_of(value: Any) -> tuple[End, End]:
    """Return both ends, from text or from a list."""
    text = ",".join(map(str, value)) if isinstance(value, list) else str(value)
    try:
        return End.parse_pair(text)
    except StackloftError as error:
        raise ValueError(_reason(error)) from error


def _quantity(value: Any, units: Mapping[str, float]) -> float:
    if isinstance(value, str):
        match = _QUANTITY.fullmatch(value)
        factor = units.get(match.group(2).lower()) if match else None
        if match is None or factor is None:
            raise ValueError(f"not a number with a unit ({', '.join(list(units)[:4])}, …)")
        return float(match.group(1)) * factor
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError("not a number")  # noqa: TRY004 - pydantic gathers ValueError
    return float(value)


def percent_of(value: Any) -> float:
    """Return per cent, from a number or from text with %."""
    return _quantity(value, {"%": 1.0})


def weight_of(value: Any) -> float:
    """Return grams."""
    return _quantity(value, GRAMS)


def volume_of(value: Any) -> float:
    """Return mm³."""
    return _quantity(value, CUBIC_MILLIMETRES)


def bare_name(value: str) -> str:
    """Return the name of a file in the same folder."""
    if not value or Path(value).name != value or value in {".", ".."}:
        raise ValueError("must be the name of a file in the same folder")
    return value


def _reason(error: StackloftError) -> str:
    return f"{error.what} ({error.expected})" if error.expected else error.what
