"""Percentages as people write them."""

from __future__ import annotations

import math

from stackloft.model.errors import UsageError


def parse_percent(text: str, what: str) -> float:
    """Return `text` such as ``0.5%`` as a number of percent; the sign is required, for 0.5 may mean 50 %.

    Parameters
    ----------
    text : str
        A positive number followed by %.
    what : str
        Name of the option, used in the message.

    Raises
    ------
    UsageError
        No number, no %, or not positive.

    Examples
    --------
    >>> parse_percent("0.5%", "--tolerance"), parse_percent("2 %", "--tolerance")
    (0.5, 2.0)
    """
    number, sign, rest = text.strip().partition("%")
    try:
        value = float(number)
    except ValueError:
        value = math.nan
    if not sign or rest or not (math.isfinite(value) and value > 0.0):
        raise UsageError("not a percentage", where=what, found=repr(text), expected="for example 0.5%")
    return value
