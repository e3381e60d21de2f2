"""A DICOM segmentation's frames: which plane and segment each is of; pixels by highdicom, when asked for."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.slice_stack import Picture
from stackloft_plugins.readers.dicom_file import ClampedFile, read_elements, safely
from stackloft_plugins.readers.dicom_frame import Frame
from stackloft_plugins.readers.dicom_header import KEYWORDS, PRIVATE, frames_of
from stackloft_plugins.readers.dicom_lookup import Lookup
from stackloft_plugins.readers.dicom_person import PERSON, person_words, shown_name

if TYPE_CHECKING:
    from pydicom import Dataset

BINARY, FRACTIONAL, LABEL_MAP = "BINARY", "FRACTIONAL", "LABELMAP"
_KEYWORDS = (
    *("SegmentationType", "SegmentSequence", "SegmentationFractionalType", "MaximumFractionalValue"),
    *("SpecificCharacterSet", "PixelPaddingValue"),
)
_MOST_FRAMES = 1 << 17
_BITS = {1: 8.0, 8: 1.0, 16: 0.5}


@dataclass(frozen=True, slots=True, eq=False)
class SegmentFrames:
    """What a file says of itself."""

    kind: str
    """``BINARY``, ``FRACTIONAL`` or ``LABELMAP``."""
    fractional: str
    """``PROBABILITY`` or ``OCCUPANCY`` of a fractional one."""
    most: float
    """The value that stands for the whole of a pixel."""
    frames: tuple[Frame, ...]
    owners: tuple[int, ...]
    """Segment number of each frame; 0 in a label map, whose pixels tell."""
    labels: Mapping[int, str]
    """Segment number to its label, empty where it must not be shown."""
    private: tuple[tuple[str, str], ...]


def read_segment_frames(path: Path, *, keep_identifiers: bool = False) -> SegmentFrames:
    """Return a segmentation's frames and segments; no pixel is read.

    Raises
    ------
    InputError
        Damaged, of a kind that is not known, or without segments; nothing private is quoted.
    """
    keywords = (*KEYWORDS, *_KEYWORDS, *PERSON, *(PRIVATE if keep_identifiers else ()))
    with safely(path, "its header"), ClampedFile(path) as stream:
        data = read_elements(stream, keywords)
        _check(data, path, stream.size)
        frames = frames_of(data, path, keep_identifiers=keep_identifiers)
        person = person_words(data)
        segments = data.get("SegmentSequence") or ()
        labels = {int(item.SegmentNumber): shown_name(item.get("SegmentLabel"), person) for item in segments}
        kind = str(data.SegmentationType)
        owners = (0,) * len(frames) if kind == LABEL_MAP else tuple(_owners(data))
        most = float(data.get("MaximumFractionalValue") or 1) if kind == FRACTIONAL else 1.0
        fractional = str(data.get("SegmentationFractionalType") or "")
    labels.pop(0, None)  # a label map may list its background
    unknown = sorted(set(owners) - set(labels) - {0})
    if not labels or unknown:
        raise InputError(
            "is damaged: its frames belong to segments that it does not list",
            where=str(path),
            found=f"segment {unknown[0]}" if unknown else "no segments",
        )
    return SegmentFrames(kind, fractional, most, frames, owners, labels, frames[0].private)


def _check(data: Dataset, path: Path, size: int) -> None:
    kind = data.get("SegmentationType")
    if kind not in {BINARY, FRACTIONAL, LABEL_MAP}:
        raise InputError(
            "is a segmentation of a kind that is not known",
            where=str(path),
            found=str(kind) if str(kind).isalpha() else "none",
            expected=f"{BINARY}, {FRACTIONAL} or {LABEL_MAP}",
        )
    count = int(data.get("NumberOfFrames") or 0)
    groups = data.get("PerFrameFunctionalGroupsSequence") or ()
    if not 0 < count <= _MOST_FRAMES or len(groups) != count:
        raise InputError(
            "is damaged: it describes another number of frames than it claims",
            where=str(path),
            found=f"{len(groups)} described",
            expected=f"{count}",
        )
    uid = str(data.file_meta.get("TransferSyntaxUID", ""))
    bits = int(data.get("BitsAllocated") or 0)
    if bits not in _BITS:
        raise InputError("is damaged: impossible pixels", where=str(path), found=f"{bits} bits")
    claimed = int(data.Rows) * int(data.Columns) * count / _BITS[bits]
    if uid in {"1.2.840.10008.1.2", "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2"} and claimed > size:
        raise InputError(
            "is damaged: it ends before its last frame",
            where=str(path),
            found=f"{size} bytes",
            expected=f"{claimed:.0f} bytes of pixels",
        )


def _owners(data: Dataset) -> list[int]:
    shared = tuple(data.get("SharedFunctionalGroupsSequence") or ())[:1]
    found = []
    for own in data.PerFrameFunctionalGroupsSequence:
        number = Lookup(data, (own, *shared)).get("SegmentIdentificationSequence", "ReferencedSegmentNumber")
        found.append(int(number))
    return found


class FramePixels:
    """A segmentation's frames by number, read when asked for; safe to call from several threads.

    Parameters
    ----------
    path : Path
    shape : tuple of int
        (rows, columns) as the header says.
    """

    def __init__(self, path: Path, shape: tuple[int, int]) -> None:
        self._path = path
        self._shape = shape
        self._lock = threading.Lock()
        self._image: Any = None

    def __call__(self, number: int) -> Picture:
        """Return frame `number`, from 0.

        Raises
        ------
        InputError
            Damaged.
        """
        with self._lock, safely(self._path, "its frames"):
            if self._image is None:
                self._image = self._opened()
            picture = np.asarray(self._image.get_stored_frame(number + 1))
        if picture.shape != self._shape:
            raise InputError("is damaged: a frame is of another size", where=str(self._path))
        return picture

    def _opened(self) -> Any:
        from highdicom.seg import segread  # noqa: PLC0415 - slow to import, seldom needed

        return segread(ClampedFile(self._path))


def plane_of_frames(frames: tuple[Frame, ...], normal: FloatArray) -> list[list[int]]:
    """Return the frames of each plane, from below.

    Frames of several segments share planes; planes nearer than a twentieth of the usual gap are one.
    """
    along = np.array([frame.position @ normal for frame in frames])
    order = np.argsort(along, kind="stable")
    gaps = np.diff(along[order])
    real = gaps[gaps > 1e-3 * float(gaps.max(initial=0.0))]
    usual = float(np.median(real)) if len(real) else np.inf
    return [group.tolist() for group in np.split(order, np.flatnonzero(gaps > 0.05 * usual) + 1)]
