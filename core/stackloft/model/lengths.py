"""Lengths as people write them: ``5.6mm``, ``0.021 cm``, ``57.5um``; a bare number is millimetres."""

from __future__ import annotations

import math
import re
from decimal import Decimal

from stackloft.model.errors import UsageError

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "µm": 1e-3, "μm": 1e-3, "in": 25.4}
"""Millimetres in one unit."""

_LENGTH = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([a-zA-Zµμ]*)\s*")


def parse_length(text: str | float, what: str = "length") -> float:
    """Return `text` in millimetres.

    Parameters
    ----------
    text : str or float
        A number with an optional unit (mm, cm, m, um, in).
    what : str
        Name of the option or key, used in the message.

    Raises
    ------
    UsageError
        Not a number, an unknown unit, or not finite.

    Examples
    --------
    >>> parse_length("5.6mm"), parse_length("0.021 cm"), parse_length(7)
    (5.6, 0.21, 7.0)
    """
    if isinstance(text, bool) or not isinstance(text, (str, int, float)):
        raise UsageError("not a length", where=what, found=repr(text), expected="for example 5.6mm")
    if isinstance(text, (int, float)):
        return _finite(float(text), what)
    match = _LENGTH.fullmatch(text)
    if match is None:
        raise UsageError("not a length", where=what, found=repr(text), expected="for example 5.6mm")
    number, unit = match.groups()
    if unit and unit not in MILLIMETRES:
        raise UsageError("unknown unit", where=what, found=repr(unit), expected="mm, cm, m, um or in")
    factor = Decimal(repr(MILLIMETRES.get(unit, 1.0)))  # decimal, so that 0.021 cm is 0.21 mm to the bit
    return _finite(float(Decimal(number) * factor), what)


def parse_lengths(text: str, what: str = "lengths") -> tuple[float, ...]:
    """Return a comma-separated list of lengths in millimetres; a unit at the end serves all.

    Examples
    --------
    >>> parse_lengths("0,0.56,1.11cm")
    (0.0, 5.6, 11.1)
    """
    items = text.split(",")
    last = _LENGTH.fullmatch(items[-1])
    unit = last.group(2) if last else ""
    return tuple(parse_length(item if _has_unit(item) else f"{item}{unit}", what) for item in items)


def _has_unit(item: str) -> bool:
    match = _LENGTH.fullmatch(item)
    return bool(match and match.group(2))


def _finite(value: float, what: str) -> float:
    if not math.isfinite(value):
        raise UsageError("not a finite length", where=what, found=str(value))
    return value
