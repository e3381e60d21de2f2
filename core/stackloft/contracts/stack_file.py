"""``stack.toml``: what a folder says about the stack in it; flags win over it.

::

    kind = "face"                  # face | silhouette | slab
    section = "face"               # the same for photographs: face | silhouette
    first = "face"                 # face | cap: the first picture shows the body's outer end, not a cut
    faces = "one"                  # one | both: two pictures for each slice, its upper face first
    turned = "left-right"          # left-right | up-down | no: how slices were turned over for the lower face
    pixel_size = "0.3mm"           # a bare number is millimetres; or pixel_sizes, one for each picture,
                                   # dpi = true (a flatbed scan's tags), or a reference object:
    reference = "disc:24.25mm"     # disc | square | ruler
    reference_height = "-16mm"     # above the cut face of each picture; negative below it
    reference_stays = false        # true: that far above the first face, and it stays there
    scale_uncertainty = "0.2%"     # standard uncertainty of the pixel size
    thickness = 5.6                # or positions = "0,5.6,11.1mm", one for each picture
    kerf = "0.4mm"                 # what the blade takes away between two slices
    align = "rigid"                # none | translation | rigid: slices laid down one by one
    fiducials = "disc:8mm"         # marks beside the body that moved with each slice
    ends = "face,round:2.5mm"      # as --ends
    height = "78mm"
    background = "light"           # light | dark; found from the picture when left out
    units = "cm"                   # of the result table
    specimen = "apple 4"
    measured_weight = "182g"       # a bare number is grams
    measured_volume = "215 mL"     # a bare number is mm³

    [camera]
    distance = "600mm"             # from the lens to the first cut face
    plane = "receding"             # fixed | receding: slices are taken off the top under a fixed camera
    principal_point = [2000, 1500] # column, row; the picture's centre when left out

    [slice.7]                      # seventh picture in natural order
    threshold = 140                # on that picture's grey scale
    mask = "mask_007.png"          # white where the body is
    skip = true
    pixel_size = "0.31mm"

Reading it needs pydantic, so readers import this module when they read, not when they are listed.
"""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from stackloft.contracts.stack_values import (
    bare_name,
    ends_of,
    fiducials_of,
    length_of,
    lengths_of,
    percent_of,
    reference_of,
    volume_of,
    weight_of,
)
from stackloft.model.ends import End
from stackloft.model.errors import InputError
from stackloft.model.reference import Reference
from stackloft.model.slice_stack import Hints, SectionKind

NAME = "stack.toml"
"""The file's name."""

_Positive = Field(gt=0, allow_inf_nan=False)
_Length = Annotated[float, BeforeValidator(length_of), _Positive]
_Shift = Annotated[float, BeforeValidator(length_of)]
_Lengths = Annotated[tuple[float, ...], BeforeValidator(lengths_of)]
_Loop = Annotated[int, Field(ge=1)]
_Link = Annotated[tuple[_Loop, _Loop], Field(strict=False)]
_STRICT = ConfigDict(extra="forbid", frozen=True, strict=True)


class SliceOverride(BaseModel):
    """What is said about one slice."""

    model_config = _STRICT

    threshold: Annotated[float, Field(allow_inf_nan=False)] | None = None
    """On the picture's own grey scale."""
    mask: Annotated[str, AfterValidator(bare_name)] | None = None
    """A picture of the same size, white where the body is."""
    skip: bool = False
    links: Annotated[tuple[_Link, ...], Field(strict=False)] | None = None
    """Which loops of this slice go on as which of the next one, each numbered from 1, the largest first."""
    pixel_size: _Length | None = None


class CameraSaid(BaseModel):
    """Where the camera hung."""

    model_config = _STRICT

    distance: _Length | None = None
    """mm from the lens to the first picture's cut face."""
    plane: Literal["fixed", "receding"] | None = None
    """Whether the cut faces stay at that distance, or recede as slices are taken off the top."""
    principal_point: Annotated[tuple[float, float], Field(strict=False)] | None = None
    """(column, row) where the optical axis meets the picture, pixels; None: its centre."""


class StackFile(BaseModel):
    """A checked ``stack.toml``; lengths in mm."""

    model_config = _STRICT

    kind: Annotated[SectionKind, Field(strict=False)] | None = None
    pixel_size: _Length | None = None
    pixel_sizes: _Lengths | None = None
    dpi: bool = False
    scale_uncertainty: Annotated[float, BeforeValidator(percent_of), Field(ge=0, lt=100)] | None = None
    reference: Annotated[Reference, BeforeValidator(reference_of)] | None = None
    reference_height: _Shift | None = None
    reference_stays: bool = False
    camera: CameraSaid = CameraSaid()
    section: Literal["face", "silhouette"] | None = None
    first: Literal["face", "cap"] | None = None
    faces: Literal["one", "both"] | None = None
    turned: Literal["left-right", "up-down", "no"] | None = None
    thickness: _Length | None = None
    kerf: Annotated[float, BeforeValidator(length_of), Field(ge=0, allow_inf_nan=False)] | None = None
    positions: _Lengths | None = None
    align: Literal["none", "translation", "rigid"] | None = None
    fiducials: Annotated[Reference, BeforeValidator(fiducials_of)] | None = None
    ends: Annotated[tuple[End, End], BeforeValidator(ends_of)] | None = None
    height: _Length | None = None
    background: Literal["light", "dark"] | None = None
    units: Literal["cm", "mm", "m", "um", "in"] | None = None
    specimen: str | None = None
    measured_weight: Annotated[float, BeforeValidator(weight_of), _Positive] | None = None
    measured_volume: Annotated[float, BeforeValidator(volume_of), _Positive] | None = None
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
            align=self.align,
        )


def _override(said: SliceOverride, folder: Path) -> dict[str, Any]:
    values: dict[str, Any] = said.model_dump(exclude_none=True, exclude_defaults=True, exclude={"pixel_size"})
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
        tables: dict[Any, type[BaseModel]] = {"slice": SliceOverride, "camera": CameraSaid}
        known = tables.get(first["loc"][0], StackFile) if len(first["loc"]) > 1 else StackFile
        name = str(first["loc"][-1])
        near = difflib.get_close_matches(name, known.model_fields, n=1, cutoff=0.5)
        fix = f"did you mean {near[0]!r}?" if near else f"known keys: {', '.join(known.model_fields)}"
        return InputError(f"unknown key {key!r}", where=where, fix=fix)
    message = first["msg"].removeprefix("Value error, ")
    return InputError(f"{key} is wrong: {message}", where=where, found=repr(first["input"]))
