"""The frames of a folder's DICOM files; those of a series are mostly alike, which is read once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from stackloft.model.arrays import read_only
from stackloft.model.errors import InputError
from stackloft_plugins.readers.dicom_file import ClampedFile, read_elements, safely
from stackloft_plugins.readers.dicom_frame import Frame
from stackloft_plugins.readers.dicom_header import KEYWORDS, PRIVATE, frames_of, location_of, order_of
from stackloft_plugins.readers.dicom_lookup import Lookup
from stackloft_plugins.readers.dicom_plain import PlainHeader, PlainSamples, plain_header

_OWN = frozenset({"ImagePositionPatient", "InstanceNumber", "SliceLocation"})
"""In what the slices of a series differ."""


def read_frames(paths: Iterable[Path], *, keep_identifiers: bool = False) -> Iterator[Frame]:
    """Yield the frames of DICOM files from their headers; no pixel is read.

    Raises
    ------
    InputError
        Damaged, no image, or without a place in space; the file is named, nothing private is quoted.
    """
    plain = _PlainFrames()
    keywords = (*KEYWORDS, *PRIVATE) if keep_identifiers else KEYWORDS
    for path in paths:
        frame = None if keep_identifiers else plain.frame(path)
        if frame is not None:
            yield frame
            continue
        with safely(path, "its header"), ClampedFile(path) as stream:
            frames = frames_of(read_elements(stream, keywords), path, keep_identifiers=keep_identifiers)
        yield from frames


class _PlainFrames:
    """Reads plain files; of one like the last but for its place, the place alone."""

    def __init__(self) -> None:
        self._last: _Like | None = None

    def frame(self, path: Path) -> Frame | None:
        """Return the one frame of a plain file; None when pydicom must look at it, or say what is wrong."""
        try:
            header = plain_header(path, KEYWORDS)
            return None if header is None else self._frame(header, path)
        except (InputError, OSError, TypeError, ValueError, AttributeError, OverflowError):
            return None

    def _frame(self, header: PlainHeader, path: Path) -> Frame | None:
        alike = {keyword: value for keyword, value in header.values.items() if keyword not in _OWN}
        if self._last is not None and self._last.holds_for(alike, header):
            return self._last.moved(header, path)
        frames = frames_of(header, path)
        if len(frames) != 1:
            return None
        frame = replace(frames[0], samples_at=header.samples())
        self._last = _Like(alike, header.pixels_length, frame)
        return frame


class _Like:
    """What the files of a series share: made into a frame once."""

    def __init__(self, alike: dict[str, Any], pixels_length: int, frame: Frame) -> None:
        self._alike = alike
        self._pixels_length = pixels_length
        self._shared = {field.name: getattr(frame, field.name) for field in fields(frame)}
        self._samples = frame.samples_at

    def holds_for(self, alike: dict[str, Any], header: PlainHeader) -> bool:
        """Return whether a header differs by `_OWN` alone; `alike` is the rest of it."""
        return alike == self._alike and header.pixels_length == self._pixels_length

    def moved(self, header: PlainHeader, path: Path) -> Frame | None:
        """Return the frame of such a header; None without a place."""
        lookup, samples = Lookup(header, ()), self._samples
        position = lookup.floats("PlanePositionSequence", "ImagePositionPatient", 3)
        if position is None:
            return None
        own = {
            "path": path,
            "name": path.name,
            "order": (*order_of(lookup), 0),
            "position": read_only(position),
            "location": location_of(lookup),
            "samples_at": samples and PlainSamples(header.pixels_at, samples.dtype, samples.spare),
        }
        return Frame(**(self._shared | own))
