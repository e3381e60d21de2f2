r"""The quick way through a plain DICOM file: explicit little-endian elements one after the other.

::

    0008 0060 | CS | 2 | "CT"        tag, type, length, value; the next element follows at once
    0028 0010 | US | 2 | 512
    7FE0 0010 | OW | 0 | 524288 | stored values …

pydicom spends most of its time on generality that a slice of a scanner's series does not need. Whatever is
not plain (another transfer syntax or byte order, wanted sequences, undefined lengths, elements out of order,
odd text) is no error: None says that pydicom must read the file.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.reused_memory import SLICE, empty
from stackloft_plugins.readers.dicom_sniff import first_bytes

EXPLICIT_LITTLE = "1.2.840.10008.1.2.1"
_HEADER = 1 << 15
"""Bytes looked at; a longer header is not plain."""
_USUAL = 1 << 12
"""Bytes looked at first: a scanner's header is seldom longer."""
_PIXELS = 0x7FE00010
_SYNTAX = 0x00020010
_SAMPLES = frozenset({b"OW", b"OB"})
_LONG = frozenset({b"OB", b"OD", b"OF", b"OL", b"OV", b"OW", b"SQ", b"SV", b"UC", b"UN", b"UR", b"UT", b"UV"})
_SHORT = frozenset(
    b"AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US".split()
)  # value types whose length takes two bytes
_TYPES = _SHORT | _LONG
_NUMBERS = {b"US": "H", b"SS": "h", b"UL": "I", b"SL": "i", b"FD": "d", b"FL": "f"}
_TEXTS = frozenset({b"CS", b"UI", b"DS", b"IS", b"LO", b"SH"})
_UNDEFINED = 0xFFFFFFFF
_ELEMENT = struct.Struct("<HH2sH").unpack_from
_LENGTH = struct.Struct("<I").unpack_from


@dataclass(frozen=True, slots=True)
class PlainSamples:
    """Where a file's stored values lie, little endian, row after row."""

    at: int
    """Byte"""
    dtype: str
    spare: int
    """Bits of each value that are not used, and mean nothing."""

    def read(self, path: Path, shape: tuple[int, int]) -> NDArray[Any] | None:
        """Return the stored values, (rows, columns); None when the file is gone or too short."""
        values = empty(shape, self.dtype, SLICE)
        try:
            with path.open("rb", buffering=0) as stream:
                stream.seek(self.at)
                got = stream.readinto(values.reshape(-1).view(np.uint8).data)
        except OSError:
            return None
        if got != values.nbytes:
            return None
        return values << self.spare >> self.spare if self.spare else values


@dataclass(frozen=True, slots=True)
class PlainHeader:
    """The wanted elements of a plain file, by keyword, and where its pixel data lie."""

    values: dict[str, Any]
    pixels_at: int
    """Byte"""
    pixels_length: int
    """Bytes"""

    def get(self, keyword: str, default: Any = None) -> Any:
        """Return an element's value as pydicom would give it, or the default where there is none."""
        return self.values.get(keyword, default)

    @property
    def file_meta(self) -> dict[str, str]:
        """The file's own group, as far as it matters."""
        return {"TransferSyntaxUID": EXPLICIT_LITTLE}

    def samples(self) -> PlainSamples | None:
        """Return where the samples of its one grey picture lie; None when they are not so simple."""
        allocated, stored = self.get("BitsAllocated"), self.get("BitsStored")
        need = self.get("Rows") * self.get("Columns") * allocated // 8
        simple = (
            allocated in {8, 16, 32}
            and self.get("HighBit", stored - 1) == stored - 1
            and self.get("SamplesPerPixel", 1) == 1
            and self.get("NumberOfFrames") in {1, None}
            and self.get("PhotometricInterpretation") in {"MONOCHROME1", "MONOCHROME2"}
            and self.pixels_length in {need, need + 1}
        )
        kind = "i" if self.get("PixelRepresentation") else "u"
        return (
            PlainSamples(self.pixels_at, f"<{kind}{allocated // 8}", allocated - stored) if simple else None
        )


def plain_header(path: Path, keywords: tuple[str, ...]) -> PlainHeader | None:
    """Return the wanted elements of a file, or None when the file is not plain.

    Raises
    ------
    OSError
        The file cannot be opened.
    """
    head = first_bytes(path, _USUAL)
    found = _header(head, _tags(keywords))
    if found is None and len(head) == _USUAL:
        found = _header(first_bytes(path, _HEADER), _tags(keywords))
    return found


def _header(head: bytes, wanted: dict[int, str]) -> PlainHeader | None:
    """Return the wanted elements of a file that begins so, or None when it is not plain, or runs on."""
    if head[128:132] != b"DICM":
        return None
    values: dict[str, Any] = {}
    at, last = 132, 0
    try:
        while last != _PIXELS:
            group, element, kind, length = _ELEMENT(head, at)
            tag = group << 16 | element
            start = at + 8
            if kind in _LONG:
                start, length = at + 12, _LENGTH(head, at + 8)[0]
            at = start + length
            _check_element(tag, kind, length, last, at <= len(head))
            last = tag
            if tag in wanted:
                values[wanted[tag]] = _value(kind, head[start:at])
            elif tag == _SYNTAX and _value(kind, head[start:at]) != EXPLICIT_LITTLE:
                return None
    except (struct.error, ValueError):
        return None
    return PlainHeader(values, start, length)


def _check_element(tag: int, kind: bytes, length: int, last: int, whole: bool) -> None:
    """Raise ValueError for an element that is not plain."""
    plain = whole and kind in _TYPES if tag != _PIXELS else kind in _SAMPLES
    if not (plain and last < tag <= _PIXELS) or length == _UNDEFINED:
        raise ValueError(tag)


@lru_cache(maxsize=4096)
def _value(kind: bytes, raw: bytes) -> Any:
    """Return a value, a tuple of several, or None of an empty one.

    Raises
    ------
    ValueError
        It is not what its type says.
    """
    if kind not in _TEXTS and kind not in _NUMBERS:
        raise ValueError(kind)
    if kind in _NUMBERS:
        code = _NUMBERS[kind]
        several = struct.unpack(f"<{len(raw) // struct.calcsize(code)}{code}", raw)
    else:
        text = raw.decode("ascii").rstrip("\0 ")
        parts = [part.strip(" ") for part in text.split("\\")] if text else []
        several = tuple(float(x) if kind == b"DS" else int(x) if kind == b"IS" else x for x in parts)
    return several if len(several) > 1 else several[0] if several else None


@lru_cache
def _tags(keywords: tuple[str, ...]) -> dict[int, str]:
    from pydicom.datadict import tag_for_keyword  # noqa: PLC0415 - slow to import, needed where DICOM is read

    numbers = {keyword: tag_for_keyword(keyword) for keyword in keywords}
    return {number: keyword for keyword, number in numbers.items() if number}
