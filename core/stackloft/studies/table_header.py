"""Column names of a table of specimens, as people write them: many words, and the unit beside them.

``weight_g``, ``Weight (g)``, ``mass [kg]`` and ``W_g`` are one column. A quantity without a unit is refused:
grams are not assumed, as spacing is not assumed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from types import MappingProxyType

from stackloft.model.errors import InputError

_GRAMS = {"g": 1.0, "kg": 1e3, "mg": 1e-3, "oz": 28.349523125, "lb": 453.59237}
_CM3 = {"cm3": 1.0, "ml": 1.0, "cc": 1.0, "mm3": 1e-3, "l": 1e3, "dm3": 1e3, "m3": 1e6, "in3": 2.54**3}
_CM2 = {"cm2": 1.0, "mm2": 1e-2, "dm2": 1e2, "m2": 1e4, "in2": 2.54**2}


@dataclass(frozen=True, slots=True)
class Quantity:
    """A column that a table must have."""

    name: str
    units: Mapping[str, float]
    """Unit (lower case) to the factor into the first one; empty for text."""
    words: tuple[str, ...]
    """What people call it, lower case with underscores, without the unit."""
    required: bool = True


QUANTITIES = (
    Quantity("sample", {}, ("sample", "specimen", "id", "name", "sample_id"), required=False),
    Quantity("group", {}, ("group", "variety", "cultivar", "kind", "species", "product"), required=False),
    Quantity("weight", MappingProxyType(_GRAMS), ("weight", "mass", "w", "measured_weight")),
    Quantity(
        "volume_measured",
        MappingProxyType(_CM3),
        ("volume_measured", "measured_volume", "experimental_volume", "v_measured", "v_exp"),
    ),
    Quantity(
        "volume_estimated",
        MappingProxyType(_CM3),
        ("volume_estimated", "estimated_volume", "volume", "v_estimated", "v_est", "v"),
    ),
    Quantity(
        "area_estimated",
        MappingProxyType(_CM2),
        ("area_estimated", "estimated_area", "area", "surface_area", "surface", "s_estimated", "s_est", "s"),
    ),
)  # fmt: skip
"""The columns of Table 1 of Goñi, Purlis & Salvadori (2007) that the statistics need."""

_UNIT_WORDS = frozenset(unit for quantity in QUANTITIES for unit in quantity.units)


@dataclass(frozen=True, slots=True)
class Column:
    """Where one quantity stands in a table."""

    index: int
    header: str
    """As it is written in the file."""
    factor: float
    """Into g, cm³ or cm²."""


def split_header(text: str) -> tuple[str, str]:
    """Return the words (lower case, underscores) and the unit, ``""`` when there is none.

    Examples
    --------
    >>> split_header("Measured volume (cm³)"), split_header("area_estimated_cm2"), split_header("W")
    (('measured_volume', 'cm3'), ('area_estimated', 'cm2'), ('w', ''))
    """
    plain = text.strip().casefold().replace("²", "2").replace("³", "3").replace("^", "")
    words = [word for word in re.split(r"[^\w]+|_", plain) if word]
    if len(words) > 1 and words[-1] in _UNIT_WORDS:
        return "_".join(words[:-1]), words[-1]
    return "_".join(words), ""


def find_columns(header: Sequence[str], where: str) -> dict[str, Column]:
    """Return where each quantity stands, by its name; optional ones that are missing are left out.

    Parameters
    ----------
    header : sequence of str
        The table's first row.
    where : str
        File and row, for messages.

    Raises
    ------
    InputError
        A required column is missing, stands there twice, or has no unit or one that is not known.

    Examples
    --------
    >>> find_columns(["weight (kg)", "volume_measured_ml", "V [cm3]", "S [cm2]"], "t.csv")["weight"].factor
    1000.0
    """
    names = [split_header(text) for text in header]
    found = {}
    for quantity in QUANTITIES:
        places = [place for place, (words, _) in enumerate(names) if words in quantity.words]
        if len(places) > 1:
            both = " and ".join(repr(header[place]) for place in places)
            raise InputError(f"two columns give the {_spoken(quantity)}", where=where, found=both,
                             fix="leave one of them out")  # fmt: skip
        if places:
            unit = names[places[0]][1]
            found[quantity.name] = Column(
                places[0], header[places[0]], _factor(quantity, header[places[0]], unit, where)
            )
        elif quantity.required:
            raise _missing(quantity, header, where)
    return found


def _factor(quantity: Quantity, header: str, unit: str, where: str) -> float:
    if not quantity.units:
        return 1.0
    if unit not in quantity.units:
        known = ", ".join(quantity.units)
        what = f"column {header!r} has " + (f"the unit {unit}" if unit else "no unit that is known")
        raise InputError(what, where=where, expected=known, fix=f"name it {_usual(quantity)}")
    return quantity.units[unit]


def _missing(quantity: Quantity, header: Sequence[str], where: str) -> InputError:
    near = get_close_matches(_usual(quantity), [text.strip().casefold() for text in header], n=1, cutoff=0.75)
    hint = f" ({near[0]!r} was not taken for it)" if near else ""
    return InputError(
        f"the column {_usual(quantity)} is missing{hint}",
        where=where,
        found=", ".join(text.strip() or "(empty)" for text in header) or "nothing",
        fix=f"add it; other words for it: {', '.join(quantity.words[1:4])}, each with its unit",
    )


def _spoken(quantity: Quantity) -> str:
    return quantity.name.replace("_", " ")


def _usual(quantity: Quantity) -> str:
    return f"{quantity.name}_{next(iter(quantity.units))}" if quantity.units else quantity.name
