"""One door to written phantoms: a name, a form, a folder, options by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.catalogue import make
from stackloft.testing.phantoms.contour_file import Contours
from stackloft.testing.phantoms.phantom import Phantom
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism
from stackloft.testing.phantoms.scans import WRITERS, Scans
from stackloft.testing.phantoms.structure_set import StructureSet

FORMS: dict[str, type[Photographs | Contours | StructureSet | Scans]] = {
    "photos": Photographs,
    "contours": Contours,
    "rtstruct": StructureSet,
    **dict.fromkeys(WRITERS, Scans),
}
"""Form to the class whose fields are its options."""


def write_photos(phantom: Phantom, folder: Path | str, **options: Any) -> list[Path]:
    """Write `phantom` as photographs; options are the fields of `Photographs`. Return the files."""
    return Photographs(**_checked("photos", options)).write(phantom, Path(folder))


def write_contours(phantom: Phantom, target: Path | str, **options: Any) -> list[Path]:
    """Write `phantom` as exact loops; options are the fields of `Contours`. Return the files."""
    return Contours(**_checked("contours", options)).write(phantom, Path(target))


def write_phantom(
    name: str,
    form: str,
    folder: Path | str,
    *,
    rotation: ArrayLike | int | None = None,
    offset: ArrayLike = (0.0, 0.0, 0.0),
    parameters: Mapping[str, Any] | None = None,
    realistic: bool = False,
    seed: int = 0,
    **options: Any,
) -> list[Path]:
    """Make the phantom called `name`, write it in a form and return the files.

    Parameters
    ----------
    name : str
        One of `stackloft.testing.phantoms.NAMES`.
    form : {"photos", "contours", "rtstruct", "dicom", "dicom-seg", "nrrd", "nifti", "tiff", "bruker"}
    folder : Path or str
        Made if missing. Receives the sections, ``stack.toml`` and ``answer.json`` with the exact figures.
    rotation, offset
        The pose, as `stackloft.testing.phantoms.make` takes it.
    parameters : mapping, optional
        The body's own parameters.
    realistic : bool
        Photographs with flesh, skin, light, blur and noise that suit the phantom (`Realism.of`); an apple
        is then put on the black plate unless a plate is named, for its flesh is pale.
    seed : int
        Of the realism's random numbers.
    **options
        The fields of `Photographs` or `Contours`: sections, placing, points, tell; for photographs
        pixel_size, realism, plate, suffix, bits, turn, mirror, margin; for contours shuffle; for scans
        those of `Scans`.

    Raises
    ------
    UsageError
        Unknown name, form, parameter or option (the nearest one is suggested), or a value out of range.
    OutputError
        The system refuses to write; no half-written file is left.

    Examples
    --------
    >>> import tempfile
    >>> folder = tempfile.mkdtemp()
    >>> files = write_phantom("potato", "photos", folder, sections=3, pixel_size=1.5, parameters={"seed": 4})
    >>> [file.name for file in files][-2:]
    ['stack.toml', 'answer.json']
    >>> write_phantom("potato", "photos", folder, pixelsize=1.5)
    Traceback (most recent call last):
    stackloft.model.errors.UsageError: photos: unknown option pixelsize; fix: did you mean pixel_size?
    """
    if form not in FORMS:
        raise UsageError("unknown form", where="--as", found=repr(form), expected=", ".join(FORMS))
    phantom = make(name, rotation=rotation, offset=offset, **(parameters or {}))
    checked = _checked(form, options)
    if realistic and form != "photos":
        raise UsageError(f"{form} have no realism", where="realistic", fix="write photos")
    if realistic:
        checked.setdefault("realism", Realism.of(phantom.name))
        checked["realism"] = replace(checked["realism"], seed=seed)
        checked.setdefault("plate", "black" if phantom.name == "apple" else "white")
    if form in WRITERS:
        checked["form"] = form
        checked.setdefault("seed", seed)
    return FORMS[form](**checked).write(phantom, Path(folder))


def _checked(form: str, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options if the form has them all; lists become tuples."""
    known = [field.name for field in fields(FORMS[form])]
    for key in options:
        if key not in known:
            near = get_close_matches(key, known, n=1, cutoff=0.5)
            fix = f"did you mean {near[0]}?" if near else f"one of {', '.join(known)}"
            raise UsageError(f"unknown option {key}", where=form, fix=fix)
    return {key: tuple(value) if isinstance(value, list) else value for key, value in options.items()}
