r"""The quick way through a plain DICOM file: explicit little-endian elements one after the other.

::

    0008 0060 | CS | 2 | "CT"        tag, type, length, value; the next element follows at once
    0028 0010 | US | 2 | 512
    7FE0 0010 | OW | 0 | 524288 | stored values …

pydicom spends most of its time on generality that a slice of a scanner's series does not need. Whatever is
not plain (another transfer syntax or byte order, wanted sequences, undefined lengths, groups out of order, odd
text) is no error: None says that pydicom must read the file.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

EXPLICIT_LITTLE = "1.2.840.10008.1.2.1"
_HEADER = 1 << 15
"""Bytes looked at; a longer header is not plain."""
_PIXELS = (0x7FE0, 0x0010)
_SYNTAX = (0x0002, 0x0010)
_LONG = frozenset({b"OB", b"OD", b"OF", b"OL", b"OV", b"OW", b"SQ", b"SV", b"UC", b"UN", b"UR", b"UT", b"UV"})
_SHORT = frozenset(
    b"AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US".split()
)  # value types whose length takes two bytes
_NUMBERS = {b"US": "H", b"SS": "h", b"UL": "I", b"SL": "i", b"FD": "d", b"FL": "f"}
_TEXTS = frozenset({b"CS", b"UI", b"DS", b"IS", b"LO", b"SH"})
_UNDEFINED = 0xFFFFFFFF

Tag = tuple[int, int]


@dataclass(frozen=True, slots=True)
class PlainHeader:
    """The wanted elements of a plain file, by keyword, and where its stored values lie."""

    values: dict[str, Any]
    pixels_at: int
    """Byte at which the stored values begin."""
    pixels_length: int
    """Bytes"""

    def get(self, keyword: str) -> Any:
        """Return an element's value as pydicom would give it; None where there is none."""
        return self.values.get(keyword)


def plain_header(path: Path, keywords: tuple[str, ...]) -> PlainHeader | None:
    """Return the wanted elements of a file, or None when the file is not plain.

    Raises
    ------
    OSError
        The file cannot be opened.
    """
    with path.open("rb", buffering=0) as stream:
        head = stream.read(_HEADER)
    if head[128:132] != b"DICM":
        return None
    try:
        return _walked(head, _tags(keywords))
    except (struct.error, ValueError):
        return None


def _walked(head: bytes, wanted: dict[Tag, str]) -> PlainHeader | None:
    values: dict[str, Any] = {}
    at, last, size = 132, (0, 0), len(head)
    while at + 12 <= size:
        tag = struct.unpack_from("<HH", head, at)
        kind = head[at + 4 : at + 6]
        if tag <= last:
            return None
        if kind in _SHORT:
            length, start = int.from_bytes(head[at + 6 : at + 8], "little"), at + 8
        elif kind in _LONG:
            length, start = int.from_bytes(head[at + 8 : at + 12], "little"), at + 12
        else:
            return None
        if length == _UNDEFINED:
            return None
        if tag == _PIXELS:
            return PlainHeader(values, start, length) if kind in {b"OW", b"OB"} else None
        raw = head[start : start + length]
        if len(raw) < length or tag > _PIXELS:
            return None
        if tag == _SYNTAX and _value(kind, raw) != EXPLICIT_LITTLE:
            return None
        keyword = wanted.get(tag)
        if keyword is not None:
            if kind not in _TEXTS and kind not in _NUMBERS:
                return None
            values[keyword] = _value(kind, raw)
        at, last = start + length, tag
    return None


@lru_cache(maxsize=4096)
def _value(kind: bytes, raw: bytes) -> Any:
    """Return a value, a tuple of several, or None of an empty one.

    Raises
    ------
    ValueError
        It is not what its type says.
    """
    if kind in _NUMBERS:
        code = _NUMBERS[kind]
        several = struct.unpack(f"<{len(raw) // struct.calcsize(code)}{code}", raw)
    else:
        text = raw.decode("ascii").rstrip("\0 ")
        parts = [part.strip(" ") for part in text.split("\\")] if text else []
        several = tuple(float(x) if kind == b"DS" else int(x) if kind == b"IS" else x for x in parts)
    return several if len(several) > 1 else several[0] if several else None


@lru_cache
def _tags(keywords: tuple[str, ...]) -> dict[Tag, str]:
    from pydicom.datadict import tag_for_keyword  # noqa: PLC0415 - slow to import, needed where DICOM is read

    numbers = {keyword: tag_for_keyword(keyword) for keyword in keywords}
    return {(number >> 16, number & 0xFFFF): keyword for keyword, number in numbers.items() if number}
