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
from stackloft.contracts.stack_file import load_stack_file
from stackloft.model.arrays import FloatArray, frozen_floats, read_only
from stackloft.model.errors import InputError, UsageError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack
from stackloft.sectioning.object_choice import KIND, LARGEST, OBJECT, OBJECTS
from stackloft_plugins.readers.dicom_objects import SEGMENTATION, object_confidence, objects_at
from stackloft_plugins.readers.dicom_series import one_shape
from stackloft_plugins.readers.seg_file import (
    FRACTIONAL,
    LABEL_MAP,
    FramePixels,
    SegmentFrames,
    plane_of_frames,
    read_segment_frames,
)
from stackloft_plugins.readers.slab_notices import slab_notices
from stackloft_plugins.readers.slice_geometry import Placed, normal_of, place_slices

_WHOLE = 0.05
"""How far a gap may be from a whole number of usual gaps and still be slices left out."""
_MOST_PLANES = 10_000
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
    keep_identifiers: bool = option(
        False, "keep patient's name and number and the descriptions in what is written"
    )

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
        planes = _planes(content, source)
        number, several = _chosen(planes, self.object, source)
        stack = planes.stack(number, several)
        whole = Segmentation(
            stack,
            _Field(0.5 * content.most if content.kind == FRACTIONAL else 0.5),
            binary=content.kind != FRACTIONAL,
            labels=() if content.kind == FRACTIONAL else (1,),
        )
        return _body(whole, number, f"{source.name}, segment {planes.label(number)}")


@dataclass(frozen=True, slots=True)
class _Field:
    """A `field_of`: a segment's own pixels."""

    level: float

    def __call__(self, number: int, picture: Picture) -> SectionField:  # noqa: ARG002 - a field_of
        return SectionField(read_only(picture.astype(np.float64)), self.level, threshold=self.level)


@dataclass(frozen=True, slots=True, eq=False)
class _Planes:
    """Where the planes lie, and which frames are on each."""

    path: Path
    content: SegmentFrames
    pixels: FramePixels
    placed: Placed
    frames: tuple[dict[int, int], ...]
    """Of each plane, in order: segment number (0 in a label map) to frame number."""
    thickness: float | None

    def label(self, number: int) -> str:
        name = self.content.labels[number]
        return f"{number} ({name})" if name else str(number)

    def picture(self, plane: int, number: int) -> Picture:
        """Return a segment's pixels on a plane: 0 and 1, or fractions as they are stored."""
        own = self.frames[plane].get(0 if self.content.kind == LABEL_MAP else number)
        if own is None:
            return np.zeros(self.content.frames[0].shape, dtype=np.uint8)
        stored = self.pixels(own)
        return (stored == number).astype(np.uint8) if self.content.kind == LABEL_MAP else stored

    def size(self, number: int) -> float:
        """Return the sum of a segment's pixels, weighted by the gaps beside their planes."""
        weights = np.gradient(self.placed.positions)
        sums = [
            float(self.picture(k, number).sum(dtype=np.float64)) if number in owners or 0 in owners else 0.0
            for k, owners in enumerate(self.frames)
        ]
        return float(weights @ np.array(sums))

    def stack(self, number: int, notices: tuple[Notice, ...]) -> SliceStack:
        """Return the planes as slices that show one segment."""
        folder = self.path.parent
        count, first = len(self.frames), self.content.frames[0]
        slabs = None if self.thickness is None else frozen_floats(np.full(count, self.thickness))
        every = sorted(self.content.labels)
        scale = {FRACTIONAL: f"fraction ({self.content.fractional.lower()}), boundary at a half"}
        return SliceStack(
            decode=lambda plane: self.picture(plane, number),
            names=tuple(f"{self.path.name}[{k + 1}]" for k in range(count)),
            shape=first.shape,
            positions=self.placed.positions,
            pixel_spacing=frozen_floats(np.tile(first.spacing, (count, 1))),
            kind=SectionKind.SLAB,
            thickness=slabs,
            affine=self.placed.affine,
            hints=load_stack_file(folder).hints(folder, {}),
            notices=(*notices, *self.placed.notices, *slab_notices(self.placed.positions, slabs)),
            provenance={
                "positions": "Image Position (Patient) along the normal",
                "pixel size": "Pixel Spacing",
                "grey scale": scale.get(self.content.kind, f"{self.content.kind.lower()} segments"),
                "segment": self.label(number),
                OBJECT: str(number),
                OBJECTS: ",".join(map(str, every)),
                KIND: "segment",
                **dict(self.content.private),
            },
        )


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


def _planes(content: SegmentFrames, path: Path) -> _Planes:
    """Return the planes with those put back that were left out because they are empty.

    Raises
    ------
    InputError
        Frames of several orientations, two frames of one segment on one plane, or one plane alone.
    """
    frames = content.frames
    one_shape(frames, leave_out=False)
    groups = plane_of_frames(frames, normal_of(frames[0].axes))
    if len(groups) < 2:
        raise InputError("one slice makes no body", where=str(path), found="segments on one plane")
    owners = []
    for group in groups:
        own = {content.owners[k]: k for k in group}
        if len(own) < len(group):
            raise InputError(
                "two frames of one segment lie on one plane",
                where=str(path),
                found=", ".join(f"frame {k + 1}" for k in group[:4]),
                expected="one frame of each segment on each plane",
            )
        owners.append(own)
    points = np.array([frames[group[0]].position for group in groups])
    points, kept = _with_empty(points, normal_of(frames[0].axes), path)
    names = [f"{path.name}[{k + 1}]" for k in range(len(points))]
    slab = frames[0].thickness
    thickness = None if slab is None else np.full(len(points), slab)
    placed = place_slices(points, frames[0].axes, names, thickness, min(frames[0].spacing), allow_gaps=True)
    own_frames: list[dict[int, int]] = [{} for _ in points]
    for place, own in zip(kept, owners, strict=True):
        own_frames[place] = own
    return _Planes(path, content, FramePixels(path, frames[0].shape), placed, tuple(own_frames), slab)


def _with_empty(points: FloatArray, normal: FloatArray, path: Path) -> tuple[FloatArray, list[int]]:
    """Return the planes' places with those of empty planes between them, and where the given ones are.

    A gap that is a whole number of usual gaps holds planes that were left out.

    Raises
    ------
    InputError
        A plane lies impossibly far from the others.
    """
    gaps = np.diff(points @ normal)
    usual = float(np.quantile(gaps, 0.25))
    if not gaps.sum() < _MOST_PLANES * usual:
        raise InputError(
            "is damaged: a plane lies impossibly far from the others",
            where=str(path),
            found=f"{gaps.max():.4g} mm",
            expected=f"{usual:.4g} mm as between others",
        )
    steps = np.round(gaps / usual)
    steps = np.where(np.abs(gaps / usual - steps) <= _WHOLE, np.maximum(steps, 1), 1).astype(int)
    filled = [points[:1]]
    for k, count in enumerate(steps):
        shares = np.arange(1, count + 1)[:, None] / count
        filled.append(points[k] + shares * (points[k + 1] - points[k]))
    return np.concatenate(filled), [0, *np.cumsum(steps).tolist()]


def _chosen(planes: _Planes, wanted: str, path: Path) -> tuple[int, tuple[Notice, ...]]:
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


def _listing(planes: _Planes) -> str:
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
