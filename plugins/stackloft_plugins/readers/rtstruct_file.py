"""The regions of a DICOM structure set, as their elements give them: contours in patient millimetres.

Coordinates are taken from the bytes of Contour Data at once; pydicom would make an object of every number.
Names of regions are kept, unless a part of the patient's name or number is in them.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft_plugins.readers.dicom_file import ClampedFile, read_elements, safely
from stackloft_plugins.readers.dicom_header import PRIVATE
from stackloft_plugins.readers.dicom_person import PERSON, person_words, shown_name

if TYPE_CHECKING:
    from pydicom import Dataset

_KEYWORDS = ("SOPClassUID", "SpecificCharacterSet", "StructureSetROISequence", "ROIContourSequence", *PERSON)
_FARTHEST = 1e5
"""mm: no scanner reaches that far; a coordinate beyond is damage."""
CLOSED = frozenset({"CLOSED_PLANAR", "CLOSEDPLANAR_XOR", "CLOSED_PLANAR_XOR"})


@dataclass(frozen=True, slots=True, eq=False)
class Contour:
    """One curve of a region."""

    kind: str
    """Contour Geometric Type, for example ``CLOSED_PLANAR``."""
    points: FloatArray
    """(k, 3) patient mm"""
    slab: float | None
    """Contour Slab Thickness, mm"""


@dataclass(frozen=True, slots=True, eq=False)
class Region:
    """One region of interest."""

    number: int
    name: str
    contours: tuple[Contour, ...]


@dataclass(frozen=True, slots=True, eq=False)
class StructureSet:
    """What a file holds."""

    regions: tuple[Region, ...]
    private: tuple[tuple[str, str], ...] = ()
    """What is kept of the patient, where a person asked for it."""


def read_structure_set(path: Path, *, keep_identifiers: bool = False) -> StructureSet:
    """Return the regions of a structure set, in the order of the file.

    Raises
    ------
    InputError
        Damaged, or without a region; the file is named, nothing private is quoted.
    """
    keywords = (*_KEYWORDS, *PRIVATE) if keep_identifiers else _KEYWORDS
    with safely(path, "its contours"), ClampedFile(path) as stream:
        data = read_elements(stream, keywords)
        person = person_words(data)
        listed = data.get("StructureSetROISequence") or ()
        names = {int(item.ROINumber): shown_name(item.get("ROIName"), person) for item in listed}
        drawn = data.get("ROIContourSequence") or ()
        regions = tuple(_region(item, names, path) for item in drawn)
        kept = [(key, str(data.get(key))) for key in PRIVATE if data.get(key)] if keep_identifiers else []
    if not regions:
        raise InputError(
            "holds no drawn region", where=str(path), found=f"{len(names)} names of regions without contours"
        )
    numbers = [region.number for region in regions]
    if len(set(numbers)) < len(numbers):
        raise InputError("is damaged: two regions share a number", where=str(path))
    return StructureSet(regions, tuple(kept))


def _region(item: Dataset, names: dict[int, str], path: Path) -> Region:
    number = int(item.ReferencedROINumber)
    if number not in names:
        raise InputError(
            "is damaged: a region's contours belong to no region of its list",
            where=str(path),
            found=f"number {number}",
            expected=", ".join(map(str, names)) or "a list of regions",
        )
    contours = tuple(_contour(one, number, path) for one in item.get("ContourSequence") or ())
    return Region(number, names[number], contours)


def _contour(item: Dataset, region: int, path: Path) -> Contour:
    kind = str(item.get("ContourGeometricType") or "")
    values = _numbers(item.get_item("ContourData"))
    said = item.get("NumberOfContourPoints")
    count = len(values) // 3
    if len(values) % 3 or (said not in {None, ""} and int(said) != count):
        raise InputError(
            "is damaged: a contour has another number of points than it says",
            where=f"{path}, region {region}",
            found=f"{len(values)} coordinates",
            expected=f"3 for each of {said or 'its'} points",
        )
    if not (np.isfinite(values).all() and (np.abs(values) < _FARTHEST).all()):
        raise InputError("is damaged: a contour has impossible coordinates", where=f"{path}, region {region}")
    slab = item.get("ContourSlabThickness")
    thick = None if slab in {None, ""} else float(slab)
    return Contour(kind, frozen_floats(values.reshape(-1, 3)), thick if thick and thick > 0 else None)


def _numbers(element: Any) -> FloatArray:
    """Return the decimal strings of an element as numbers."""
    value = getattr(element, "value", None)
    if value is None:
        return np.zeros(0)
    if isinstance(value, bytes):
        text = value.replace(b"\0", b" ").decode("ascii").strip()
        return np.array([float(part) for part in text.split("\\")] if text else [])
    return np.array(value, dtype=np.float64).reshape(-1)
