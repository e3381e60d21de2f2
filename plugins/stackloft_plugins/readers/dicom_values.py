"""Values of DICOM elements, as far as they are to be trusted."""

from __future__ import annotations

import math
from typing import Any


def number_of(value: Any) -> float | None:
    """Return a finite number, or None."""
    number = None if value in {None, ""} else float(value)
    return number if number is not None and math.isfinite(number) else None


def positive_of(value: Any) -> float | None:
    """Return a positive finite number, or None."""
    number = number_of(value)
    return number if number is not None and number > 0 else None


def words_of(value: Any) -> tuple[str, ...]:
    """Return code words in capitals."""
    if value is None or isinstance(value, str):
        return (value or "",)
    return tuple(str(word).upper() for word in value)


def word_of(value: Any) -> str:
    """Return a code of at most 16 capital letters; anything else may be free text."""
    text = str(value or "")
    return text if text.isalnum() and text.isupper() and len(text) <= 4 else ""
