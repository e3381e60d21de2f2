"""Keeping a patient's name, number and birth date out of the names of regions and segments."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pydicom import Dataset

PERSON = ("PatientName", "PatientID", "PatientBirthDate")
"""Elements that tell who the patient is; read for no other end than to keep them out of names."""
_SHORTEST = 3
_LONGEST_NAME = 64


def person_words(data: Dataset) -> frozenset[str]:
    """Return the parts of the patient's name, number and birth date, lower case."""
    words = " ".join(str(data.get(key) or "") for key in PERSON)
    return frozenset(part.casefold() for part in re.split(r"[\W_]+", words) if len(part) >= _SHORTEST)


def shown_name(text: object, person: frozenset[str]) -> str:
    """Return a name as one line of printable letters, or nothing where it tells who the patient is.

    Examples
    --------
    >>> shown_name("left  lung", frozenset({"doe"})), shown_name("Doe, tumour", frozenset({"doe"}))
    ('left lung', '')
    """
    name = " ".join(str(text or "").split())[:_LONGEST_NAME]
    shown = "".join(letter for letter in name if letter.isprintable())
    return "" if any(part in shown.casefold() for part in person) else shown
