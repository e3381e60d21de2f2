"""DICOM structure sets (RTSTRUCT): regions drawn by people or programs, straight into sections.

The pictures on which they were drawn are not needed: contours are in patient millimetres. Curves of one
plane make a section by the even–odd rule, so that a curve within another bounds a hole; a hole may also be
joined to its outline by a bridge ("keyhole").
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError, UsageError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import SectionKind
from stackloft.sectioning.object_choice import KIND, LARGEST, OBJECT, OBJECTS
from stackloft_plugins.readers.dicom_objects import RTSTRUCT, object_confidence, objects_at
from stackloft_plugins.readers.rtstruct_file import CLOSED, Contour, Region, read_structure_set
from stackloft_plugins.readers.rtstruct_planes import planar_sections, vector_area
from stackloft_plugins.readers.scan_scale import CALIBRATION, with_scale

_LISTED = 20


@dataclass(frozen=True, slots=True)
class RtstructReader:
    """Reads one region of a structure set into a `ContourStack`.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> folder = Path(tempfile.mkdtemp())
    >>> _ = phantoms.write_phantom("cone", "rtstruct", folder, sections=5)
    >>> stack = RtstructReader().read(folder)
    >>> len(stack), stack.exact, stack.provenance["region"]
    (5, True, '1 (cone)')
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (ContourStack,)

    roi: str = option("", "which region: its name or number; the largest when empty")
    object: str = option(LARGEST, "which region, largest or its number; roi wins over it")
    keep_identifiers: bool = option(
        False, "keep patient's name and number and the descriptions in what is written"
    )
    scale_uncertainty: float | None = option(None, CALIBRATION, unit="%", ge=0, lt=100)

    def probe(self, path: Path) -> float:
        """Return 0.95 for a structure set, or a folder with no other DICOM file; 0 otherwise."""
        return object_confidence(path, RTSTRUCT)

    def read(self, path: Path) -> ContourStack:
        """Return the sections of one region, in the order of their positions along the planes' normal.

        Parameters
        ----------
        path : Path
            The file, or a folder with one such file in it.

        Raises
        ------
        InputError
            Damaged; no closed contour; contours that are not planar, not parallel, or cross.
        UsageError
            No region of that name or number; those that are there are listed.
        """
        source = _one_file(path)
        content = read_structure_set(source, keep_identifiers=self.keep_identifiers)
        region, several = _chosen(content.regions, self.roi or self.object, source)
        where = f"{source.name}, region {_label(region)}"
        closed, left_out = _closed(region, where)
        planes = planar_sections([contour.points for contour in closed], where)
        slabs = {contour.slab for contour in closed}
        slab = slabs.pop() if len(slabs) == 1 else None
        said = load_stack_file(source.parent)
        kind = SectionKind.FACE if slab is None else SectionKind.SLAB
        stack = ContourStack(
            sections=planes.sections,
            kind=kind if said.kind is None else said.kind,
            exact=True,
            thickness=slab,
            affine=planes.affine,
            hints=said.hints(source.parent, {}),
            notices=(*several, *left_out, *planes.notices),
            provenance={
                "positions": "Contour Data along the planes' normal",
                "region": _label(region),
                OBJECT: str(region.number),
                OBJECTS: ",".join(str(one.number) for one in _drawn(content.regions)),
                KIND: "region",
                **dict(content.private),
            },
        )
        return with_scale(stack, self.scale_uncertainty, path)


def _one_file(path: Path) -> Path:
    if not path.exists():
        raise InputError("no such file or folder", where=str(path))
    files = objects_at(path, RTSTRUCT)
    if len(files) != 1:
        raise InputError(
            "is no structure set" if path.is_file() else "is no folder with one structure set",
            where=str(path),
            found=", ".join(file.name for file in files[:5]) or "none",
            fix="name the file itself" if files else "",
        )
    return files[0]


def _label(region: Region) -> str:
    return f"{region.number} ({region.name})" if region.name else str(region.number)


def _drawn(regions: tuple[Region, ...]) -> list[Region]:
    return [region for region in regions if any(one.kind in CLOSED for one in region.contours)]


def _chosen(regions: tuple[Region, ...], wanted: str, source: Path) -> tuple[Region, tuple[Notice, ...]]:
    drawn = _drawn(regions)
    if not drawn:
        kinds = sorted({contour.kind for region in regions for contour in region.contours})
        raise InputError(
            "no region has a closed contour", where=str(source), found=", ".join(kinds) or "no contours",
            expected="CLOSED_PLANAR",
        )  # fmt: skip
    if wanted != LARGEST:
        by_number = [region for region in drawn if str(region.number) == wanted]
        found = by_number or [region for region in drawn if region.name == wanted]
        if len(found) == 1:
            return found[0], ()
        raise UsageError(
            f"{len(found)} regions have that name" if found else "no such region",
            where=f"{source.name}: --set rtstruct.roi",
            found=wanted,
            expected=_listing(found or drawn),
        )
    largest = max(drawn, key=_size)
    if len(drawn) == 1:
        return largest, ()
    text = (
        f"{len(drawn)} regions are here ({_listing(drawn)}); the largest was taken: choose with "
        f"--set rtstruct.roi={largest.number}"
    )
    return largest, (Notice("several-objects", text),)


def _listing(regions: list[Region]) -> str:
    more = f", and {len(regions) - _LISTED} more" if len(regions) > _LISTED else ""
    return ", ".join(_label(region) for region in regions[:_LISTED]) + more


def _size(region: Region) -> float:
    """Return about the region's volume, mm³: the areas of its contours times their mean distance."""
    areas = np.array([vector_area(one.points) for one in region.contours if one.kind in CLOSED])
    total = np.linalg.norm(areas, axis=1)
    normal = areas[np.argmax(total)] / max(float(total.max()), 1e-12)
    heights = [float(one.points[0] @ normal) for one in region.contours if one.kind in CLOSED]
    planes = len(np.unique(np.round(heights, 2)))
    return float(total.sum() * np.ptp(heights) / max(planes - 1, 1))


def _closed(region: Region, where: str) -> tuple[list[Contour], tuple[Notice, ...]]:
    """Return the closed contours of 3 points and more, and a notice of what is left out."""
    closed = [one for one in region.contours if one.kind in CLOSED and len(one.points) >= 3]
    others = len(region.contours) - len(closed)
    if not closed:
        raise InputError("has no closed contour of 3 points or more", where=where)
    if not others:
        return closed, ()
    kinds = sorted({one.kind for one in region.contours if one not in closed and one.kind.isascii()})
    text = f"{where}: {others} contours that enclose nothing are left out ({', '.join(kinds)})"
    return closed, (Notice("left-out", text),)
