"""Figures as people read them: one unit, no more digits than are meant."""

from __future__ import annotations

import math

from stackloft.model.lengths import MILLIMETRES

_SYMBOLS = {"um": "µm", "in": "in"}
_POWERS = {1: "", 2: "²", 3: "³"}
_DIGITS = 5
"""Significant digits of a figure whose uncertainty is not known."""


def in_unit(value: float, unit: str, power: int, digits: int = _DIGITS) -> str:
    """Return a figure given in mm, mm² or mm³ to `digits` significant digits with its unit.

    Parameters
    ----------
    value : float
        In mm to the `power`.
    unit : str
        One of `stackloft.model.lengths.MILLIMETRES`.
    power : int
        1 length, 2 area, 3 volume.
    digits : int
        Significant digits.

    Examples
    --------
    >>> in_unit(178042.3, "cm", 3), in_unit(15_320.4, "cm", 2)
    ('178.04 cm³', '153.20 cm²')
    """
    return f"{significant(value / MILLIMETRES[unit] ** power, digits)} {unit_name(unit, power)}"


def with_uncertainty(value: float, uncertainty: float | None, unit: str, power: int) -> str:
    """Return a figure with its standard uncertainty when that is known, rounded to its two digits.

    Examples
    --------
    >>> with_uncertainty(178042.3, 312.0, "cm", 3)
    '178.04 ± 0.31 cm³'
    """
    if uncertainty is None or not uncertainty > 0:
        return in_unit(value, unit, power)
    scale = MILLIMETRES[unit] ** power
    places = max(0, 1 - math.floor(math.log10(uncertainty / scale)))
    return f"{value / scale:.{places}f} ± {uncertainty / scale:.{places}f} {unit_name(unit, power)}"


def unit_name(unit: str, power: int) -> str:
    """Return the unit's name, for example ``cm³``."""
    return f"{_SYMBOLS.get(unit, unit)}{_POWERS[power]}"


def significant(value: float, digits: int = _DIGITS) -> str:
    """Return `value` to `digits` significant digits, without an exponent where that is readable.

    Examples
    --------
    >>> significant(0.99832, 3), significant(1234567.0), significant(0.0), significant(3.2e-9, 2)
    ('0.998', '1234600', '0', '3.2e-09')
    """
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    exponent = math.floor(math.log10(abs(value)))
    if not -4 <= exponent <= 9:
        return f"{value:.{digits - 1}e}"
    places = digits - 1 - exponent
    return f"{round(value, places):.{max(places, 0)}f}"


def length(value: float, unit: str) -> str:
    """Return a length that somebody gave (mm) in `unit`, with no digit that says nothing.

    Examples
    --------
    >>> length(0.3, "mm"), length(81.99999999, "cm")
    ('0.3 mm', '8.2 cm')
    """
    return f"{value / MILLIMETRES[unit]:.6g} {unit_name(unit, 1)}"
