r"""DICOM segmentations (SEG): one body for each segment, however near another.

::

    frames as stored        segment 1   segment 2      a frame is one segment on one plane; planes on which
      f1: plane 2, seg 1     plane 3       ( b )        a segment is empty are usually left out of the file
      f2: plane 3, seg 2     plane 2  ( a )             and are put back here
      …                      plane 1  ( a )

Segments may overlap; each is measured by itself. A fractional segment's boundary is where half of a pixel is
filled (or the probability is a half), found between the pixels; a binary one is a label map.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.model.arrays import read_only
from stackloft.model.errors import InputError, UsageError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.array_axis import AXES, MEMORY, along_axis
from stackloft.sectioning.object_choice import LARGEST
from stackloft_plugins.readers.dicom_objects import SEGMENTATION, object_confidence, objects_at
from stackloft_plugins.readers.label_map import best_axis_of
from stackloft_plugins.readers.scan_scale import CALIBRATION, with_scale
from stackloft_plugins.readers.seg_file import FRACTIONAL, SegmentFrames, read_segment_frames
from stackloft_plugins.readers.seg_planes import SegmentPlanes, segment_planes

_LISTED = 20


@dataclass(frozen=True, slots=True)
class DicomSegReader:
    """Reads one segment of a DICOM segmentation into a `Segmentation`.

    Examples
    --------
    >>> import tempfile
    >>> from stackloft.testing import phantoms
    >>> folder = Path(tempfile.mkdtemp())
    >>> _ = phantoms.write_phantom("cone", "dicom-seg", folder, sections=5, pixel_size=2.0)
    >>> found = DicomSegReader().read(folder)
    >>> found.binary, found.stack.provenance["segment"]
    (False, '1 (cone)')
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (Segmentation,)

    object: str = option(LARGEST, "which segment: largest, its number or its label")
    axis: str = option("0", "the array's axis that sections are taken across", choices=AXES)
    memory: float = option(MEMORY, "what another axis than 0 may take for the whole map", unit="MB", gt=0)
    keep_identifiers: bool = option(
        False, "keep patient's name and number and the descriptions in what is written"
    )
    scale_uncertainty: float | None = option(None, CALIBRATION, unit="%", ge=0, lt=100)

    def probe(self, path: Path) -> float:
        """Return 0.95 for a segmentation, or a folder with no other DICOM file; 0 otherwise."""
        return object_confidence(path, SEGMENTATION)

    def read(self, path: Path) -> Segmentation:
        """Return one segment's body on the planes where it is.

        Parameters
        ----------
        path : Path
            The file, or a folder with one such file in it.

        Raises
        ------
        InputError
            Damaged; planes of several orientations or without a place; an empty segment.
        UsageError
            No segment of that number or label; those that are there are listed.
        """
        source = _one_file(path)
        content = read_segment_frames(source, keep_identifiers=self.keep_identifiers)
        planes = segment_planes(content, source)
        number, several = _chosen(planes, self.object, source)
        stack = planes.stack(number, several)
        where = f"{source.name}, segment {planes.label(number)}"
        body = _body(_segmentation(stack, content), number, where)
        axis, told = (int(self.axis), ()) if self.axis != "auto" else best_axis_of(body)
        if axis:
            body = _body(_segmentation(along_axis(stack, axis, self.memory), content), number, where)
        return with_scale(replace(body, notices=(*body.notices, *told)), self.scale_uncertainty, path)


def _segmentation(stack: SliceStack, content: SegmentFrames) -> Segmentation:
    if content.kind == FRACTIONAL:
        return Segmentation(stack, _Field(0.5 * content.most))
    return Segmentation(stack, _Field(0.5), binary=True, labels=(1,))


@dataclass(frozen=True, slots=True)
class _Field:
    """A `field_of`: a segment's own pixels."""

    level: float

    def __call__(self, number: int, picture: Picture) -> SectionField:  # noqa: ARG002 - a field_of
        return SectionField(read_only(picture.astype(np.float64)), self.level, threshold=self.level)


def _one_file(path: Path) -> Path:
    if not path.exists():
        raise InputError("no such file or folder", where=str(path))
    files = objects_at(path, SEGMENTATION)
    if len(files) != 1:
        raise InputError(
            "is no DICOM segmentation" if path.is_file() else "is no folder with one DICOM segmentation",
            where=str(path),
            found=", ".join(file.name for file in files[:5]) or "none",
            fix="name the file itself" if files else "",
        )
    return files[0]


def _chosen(planes: SegmentPlanes, wanted: str, path: Path) -> tuple[int, tuple[Notice, ...]]:
    labels = planes.content.labels
    if wanted != LARGEST:
        found = [number for number in labels if str(number) == wanted]
        found = found or [number for number, label in labels.items() if label == wanted]
        if len(found) == 1:
            return found[0], ()
        what = f"{len(found)} segments have that label" if found else "no such segment"
        raise UsageError(what, where=f"{path.name}: --object", found=wanted, expected=_listing(planes))
    if len(labels) == 1:
        return next(iter(labels)), ()
    largest = max(sorted(labels), key=planes.size)
    text = (
        f"{len(labels)} segments are here ({_listing(planes)}); measured is {largest}: "
        "choose another with --object"
    )
    return largest, (Notice("several-objects", text),)


def _listing(planes: SegmentPlanes) -> str:
    numbers = sorted(planes.content.labels)
    more = f", and {len(numbers) - _LISTED} more" if len(numbers) > _LISTED else ""
    return ", ".join(planes.label(number) for number in numbers[:_LISTED]) + more


def _body(whole: Segmentation, number: int, where: str) -> Segmentation:
    """Return the segment's largest piece on its own slices; stray voxels are told.

    Raises
    ------
    InputError
        The segment is empty.
    """
    from stackloft.sectioning.objects import find_objects  # noqa: PLC0415 - it needs OpenCV

    try:
        found = find_objects(whole)
    except InputError as error:
        raise InputError("the segment is empty", where=where) from error
    body = max(found, key=lambda one: one.size)
    stray = sum(one.size for one in found) - body.size
    notices = tuple(
        replace(notice, message=notice.message.replace("label 1:", f"segment {number}:"))
        for notice in body.segmentation.notices
    )
    if stray:
        share = 100 * stray / body.size
        text = (
            f"segment {number}: left out {stray:.4g} mm³ ({share:.2g} %) in other pieces, away from its body"
        )
        notices = (*notices, Notice("stray-voxels", text))
    return replace(body.segmentation, notices=notices)
