"""Checks of bodies' parameters."""

from __future__ import annotations

import math

from stackloft.model.errors import UsageError


def positive(**lengths: float) -> None:
    """Raise UsageError when a parameter is not a finite positive number.

    Examples
    --------
    >>> positive(radius=-1)
    Traceback (most recent call last):
    stackloft.model.errors.UsageError: radius: must be a positive number; found: -1
    """
    for name, value in lengths.items():
        if not (math.isfinite(value) and value > 0):
            raise UsageError("must be a positive number", where=name, found=f"{value:g}")


def within(low: float, high: float, **values: float) -> None:
    """Raise UsageError when a parameter is outside [low, high].

    Examples
    --------
    >>> within(0, 1, taper=0.4)
    """
    for name, value in values.items():
        if not low <= value <= high:
            raise UsageError(
                "outside the range", where=name, found=f"{value:g}", expected=f"{low:g} to {high:g}"
            )
