"""``stackloft phantom``: a stack whose answer is known."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from stackloft.cli.screen import console
from stackloft.cli.units import in_unit
from stackloft.model.errors import UsageError
from stackloft.model.lengths import parse_length, parse_lengths
from stackloft.testing.phantoms.camera import Camera
from stackloft.testing.phantoms.reference_object import ReferenceObject
from stackloft.testing.phantoms.scans import WRITERS
from stackloft.testing.phantoms.writing import write_phantom


def run(name: str, form: str, folder: Path, options: Mapping[str, Any], parameters: Iterable[str]) -> None:
    """Write the phantom and print its exact figures.

    Parameters
    ----------
    name, form, folder
        As for `stackloft.testing.phantoms.writing.write_phantom`.
    options : mapping
        Its options as text or typed; None is left out.
    parameters : iterable of str
        The body's own, ``key=value``.

    Raises
    ------
    StackloftError
        An unknown name, form, option or parameter, or a folder that cannot be written.
    """
    chosen = {key: value for key, value in options.items() if value is not None}
    typed = _typed(chosen)
    if form in WRITERS and isinstance(typed.get("placing"), tuple):
        typed["positions"] = typed.pop("placing")
    files = write_phantom(name, form, folder, parameters=parameters_of(parameters), **typed)
    known = json.loads(next(path for path in files if path.name == "answer.json").read_text(encoding="utf-8"))
    volume, area = known["volume"]["value"], known["area"]["value"]
    screen = console()
    screen.print(
        f"{name}: volume {in_unit(volume, 'cm', 3)}, area {in_unit(area, 'cm', 2)} (exact: answer.json)"
    )
    screen.print(f"{len(files)} files in {folder}", soft_wrap=True, markup=False)


def parameters_of(texts: Iterable[str]) -> dict[str, float | int]:
    """Return a body's parameters from ``key=value``; whole numbers stay whole, lengths come out in mm.

    Raises
    ------
    UsageError
        A text of another form.

    Examples
    --------
    >>> parameters_of(["a=3cm", "degree=4", "p=2.5"])
    {'a': 30.0, 'degree': 4, 'p': 2.5}
    """
    parameters: dict[str, float | int] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not (equals and key.strip()):
            raise UsageError(
                "not a parameter", where="--set", found=repr(text), expected="for example a=30mm"
            )
        whole = value.strip().removeprefix("-").isdecimal()
        parameters[key.strip()] = int(value) if whole else parse_length(value, f"--set {key.strip()}")
    return parameters


def _typed(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options that are written as text in the types that phantoms take."""
    typed = dict(options)
    if "pixel_size" in typed:
        typed["pixel_size"] = parse_length(typed["pixel_size"], "--pixel-size")
    if "offset" in typed:
        typed["offset"] = parse_lengths(typed["offset"], "--offset")
    if "rotation" in typed:
        typed["rotation"] = _rotation(typed["rotation"])
    if "placing" in typed and typed["placing"] not in {"mid", "faces"}:
        typed["placing"] = parse_lengths(typed["placing"], "--placing")
    if "origin" in typed:
        typed["origin"] = _triple(typed["origin"])
    if "margin" in typed:
        typed["margin"] = parse_length(typed["margin"], "--margin")
    if "levels" in typed:
        typed["levels"] = _levels(typed["levels"])
    if "camera" in typed:
        typed["camera"] = Camera.parse(typed["camera"])
    typed |= _reference(typed)
    if "tell" in typed:
        typed["tell"] = tuple(key.strip() for key in typed["tell"].split(",") if key.strip())
    return typed


def _reference(typed: dict[str, Any]) -> dict[str, ReferenceObject]:
    """Take the reference object's flags out of `typed` and return them as one option."""
    where = {name: typed.pop(f"reference_{name}", None) for name in ("height", "stays", "once")}
    if "reference" not in typed:
        if any(value is not None for value in where.values()):
            raise UsageError("there is no reference object", where="--reference-…", fix="give --reference")
        return {}
    height = 0.0 if where["height"] is None else parse_length(where["height"], "--reference-height")
    seen = replace(
        ReferenceObject.parse(typed["reference"]),
        height=height,
        stays=bool(where["stays"]),
        pictures="first" if where["once"] else "every",
    )
    return {"reference": seen}


def _rotation(text: str) -> int | tuple[float, ...]:
    parts = text.split(",")
    try:
        return int(text) if len(parts) == 1 else tuple(float(part) for part in parts)
    except ValueError:
        raise UsageError(
            "not a rotation", where="--rotation", found=repr(text), expected="a seed, or x,y,z in degrees"
        ) from None


def _triple(text: str) -> tuple[float, ...]:
    lengths = parse_lengths(text, "--origin")
    if len(lengths) != 3:
        raise UsageError("not a place in space", where="--origin", found=repr(text), expected="LEN,LEN,LEN")
    return lengths


def _levels(text: str) -> tuple[float, ...]:
    try:
        levels = tuple(float(part) for part in text.split(","))
    except ValueError:
        levels = ()
    if len(levels) != 2 or levels[0] == levels[1]:
        raise UsageError(
            "not two grey levels", where="--levels", found=repr(text), expected="AIR,BODY, as -1000,40"
        )
    return levels
