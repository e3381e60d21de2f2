"""``stack.toml``: what a folder says about the stack in it; flags win over it.

::

    kind = "face"                  # face | silhouette | slab
    pixel_size = "0.3mm"           # a bare number is millimetres
    thickness = 5.6                # or positions = "0,5.6,11.1mm", one for each picture
    ends = "face,round:2.5mm"      # as --ends
    height = "78mm"
    background = "light"           # light | dark; found from the picture when left out
    units = "cm"                   # of the result table
    specimen = "apple 4"
    measured_weight = "182g"       # a bare number is grams
    measured_volume = "215 mL"     # a bare number is mm³

    [slice.7]                      # seventh picture in natural order
    threshold = 140                # on that picture's grey scale
    mask = "mask_007.png"          # white where the body is
    skip = true

Reading it needs pydantic, so readers import this module when they read, not when they are listed.
"""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from stackloft.model.ends import End
from stackloft.model.errors import InputError, StackloftError
from stackloft.model.lengths import MILLIMETRES, parse_length, parse_lengths
from stackloft.model.slice_stack import Hints, SectionKind

NAME = "stack.toml"
"""The file's name."""

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


def _length(value: Any) -> float:
    try:
        return parse_length(value)
    except StackloftError as error:
        raise ValueError(_reason(error)) from error


def _lengths(value: Any) -> tuple[float, ...]:
    if not isinstance(value, (str, list)):
        raise ValueError('not a list of lengths, as "0,5.6,11.1mm"')  # noqa: TRY004 - pydantic gathers ValueError
    try:
        return parse_lengths(value) if isinstance(value, str) else tuple(parse_length(item) for item in value)
    except StackloftError as error:
        raise ValueError(_reason(error)) from error


def _ends(value: Any) -> tuple[End, End]:
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


def _weight(value: Any) -> float:
    return _quantity(value, GRAMS)


def _volume(value: Any) -> float:
    return _quantity(value, CUBIC_MILLIMETRES)


def _bare_name(value: str) -> str:
    if not value or Path(value).name != value or value in {".", ".."}:
        raise ValueError("must be the name of a file in the same folder")
    return value


def _reason(error: StackloftError) -> str:
    return f"{error.what} ({error.expected})" if error.expected else error.what


_Positive = Field(gt=0, allow_inf_nan=False)
_Length = Annotated[float, BeforeValidator(_length), _Positive]
_STRICT = ConfigDict(extra="forbid", frozen=True, strict=True)


class SliceOverride(BaseModel):
    """What is said about one slice."""

    model_config = _STRICT

    threshold: Annotated[float, Field(allow_inf_nan=False)] | None = None
    """On the picture's own grey scale."""
    mask: Annotated[str, AfterValidator(_bare_name)] | None = None
    """A picture of the same size, white where the body is."""
    skip: bool = False


class StackFile(BaseModel):
    """A checked ``stack.toml``; lengths in mm."""

    model_config = _STRICT

    kind: Annotated[SectionKind, Field(strict=False)] | None = None
    pixel_size: _Length | None = None
    thickness: _Length | None = None
    positions: Annotated[tuple[float, ...], BeforeValidator(_lengths)] | None = None
    ends: Annotated[tuple[End, End], BeforeValidator(_ends)] | None = None
    height: _Length | None = None
    background: Literal["light", "dark"] | None = None
    units: Literal["cm", "mm", "m", "um", "in"] | None = None
    specimen: str | None = None
    measured_weight: Annotated[float, BeforeValidator(_weight), _Positive] | None = None
    measured_volume: Annotated[float, BeforeValidator(_volume), _Positive] | None = None
    slice: dict[Annotated[int, Field(ge=1, strict=False)], SliceOverride] = {}

    def hints(self, folder: Path, numbers: Mapping[int, int]) -> Hints:
        """Return what later stages need.

        Parameters
        ----------
        folder : Path
            Where masks lie.
        numbers : mapping of int to int
            Slice number in the file to slice number in the stack, both from 1; others are left out.
        """
        slices = {
            numbers[number]: _override(said, folder)
            for number, said in self.slice.items()
            if number in numbers
        }
        return Hints(
            ends=self.ends,
            height=self.height,
            background=self.background,
            specimen=self.specimen,
            measured_weight=self.measured_weight,
            measured_volume=self.measured_volume,
            slices={number: said for number, said in slices.items() if said},
        )


def _override(said: SliceOverride, folder: Path) -> dict[str, Any]:
    values: dict[str, Any] = said.model_dump(exclude_none=True, exclude_defaults=True)
    if said.mask is not None:
        values["mask"] = folder / said.mask
    return values


def load_stack_file(folder: Path) -> StackFile:
    """Return what ``stack.toml`` in `folder` says; a `StackFile` that says nothing when there is none.

    Raises
    ------
    InputError
        The file is no TOML, has an unknown key (the nearest known one is named) or a wrong value.

    Examples
    --------
    >>> load_stack_file(Path("/nonexistent")).pixel_size is None
    True
    """
    path = folder / NAME
    if not path.is_file():
        return StackFile()
    return parse_stack_file(_read_text(path), str(path))


def parse_stack_file(text: str, where: str = NAME) -> StackFile:
    """Return what the text of a ``stack.toml`` says; `where` names it in messages.

    Examples
    --------
    >>> parse_stack_file('measured_volume = "0.2 L"').measured_volume
    200000.0
    >>> parse_stack_file("thicknes = 5")
    Traceback (most recent call last):
    stackloft.model.errors.InputError: stack.toml: unknown key 'thicknes'; fix: did you mean 'thickness'?
    """
    try:
        return StackFile.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise InputError("is not valid TOML", where=where, found=str(error)) from error
    except ValidationError as error:
        raise _explain(error, where) from error


def _read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(
            "cannot be read", where=str(path), found=str(error), fix="save it as UTF-8"
        ) from error


def _explain(error: ValidationError, where: str) -> InputError:
    """Return the first complaint in the house's words."""
    first = error.errors(include_url=False)[0]
    key = ".".join(str(part) for part in first["loc"] if part != "[key]")
    if first["type"] == "extra_forbidden":
        known = SliceOverride if first["loc"][0] == "slice" else StackFile
        name = str(first["loc"][-1])
        near = difflib.get_close_matches(name, known.model_fields, n=1, cutoff=0.5)
        fix = f"did you mean {near[0]!r}?" if near else f"known keys: {', '.join(known.model_fields)}"
        return InputError(f"unknown key {key!r}", where=where, fix=fix)
    message = first["msg"].removeprefix("Value error, ")
    return InputError(f"{key} is wrong: {message}", where=where, found=repr(first["input"]))
