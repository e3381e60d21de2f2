"""A plug-in's options are its dataclass fields; this module says what a field may carry.

One declaration gives command-line flags, recipe keys, JSON Schema, validation and provenance.
"""

from __future__ import annotations

import dataclasses
from typing import Any

UNITS = frozenset({"", "mm", "mm^2", "%", "px", "s", "MB", "deg", "HU"})


def option(
    default: Any,
    help: str,  # noqa: A002 - the field's everyday word for an option's text
    *,
    unit: str = "",
    ge: float | None = None,
    gt: float | None = None,
    le: float | None = None,
    lt: float | None = None,
    choices: tuple[str, ...] | None = None,
    source: str | None = None,
) -> Any:
    """Declare one option of a plug-in.

    Parameters
    ----------
    default : object
        The value when nobody says otherwise; its immutability is required.
    help : str
        One sentence for people.
    unit : str
        Unit of the value; ``mm`` options also accept text such as ``5.6mm``.
    ge, gt, le, lt : float, optional
        Bounds.
    choices : tuple of str, optional
        The allowed words.
    source : str, optional
        Where the default comes from (author, year).

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Threshold:
    ...     level: float = option(0.5, "fraction of full scale", ge=0, le=1)
    >>> Threshold().level
    0.5
    """
    if unit not in UNITS:
        message = f"unknown unit {unit!r}"
        raise ValueError(message)
    bounds = {"ge": ge, "gt": gt, "le": le, "lt": lt}
    metadata = {
        "help": help,
        "unit": unit,
        "bounds": {key: value for key, value in bounds.items() if value is not None},
        "choices": choices,
        "source": source,
    }
    return dataclasses.field(default=default, metadata={"stackloft": metadata})
