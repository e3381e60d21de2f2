"""What an ITK file says of itself in its first bytes: the format, and whether it gives a spacing at all.

ITK puts 1 where a file is silent; a spacing that nobody gave must not be measured with, so the header's own
words are looked at.
"""

from __future__ import annotations

import gzip
import re
import struct
from dataclasses import dataclass
from pathlib import Path

from stackloft.model.errors import InputError
from stackloft.model.lengths import MILLIMETRES

_HEAD = 1 << 14
_NIFTI_UNITS = {1: "m", 2: "mm", 3: "um"}
_UNIT_NAMES = {"millimeter": "mm", "millimetre": "mm", "micron": "um", "micrometer": "um", "meter": "m"}


@dataclass(frozen=True, slots=True)
class ItkHeader:
    """What matters before the file is read."""

    form: str
    """``NRRD``, ``MetaImage`` or ``NIfTI``."""
    spaced: bool
    """Whether the file gives a spacing."""
    factor: float = 1.0
    """Millimetres in the unit that the file's numbers are in, where ITK does not convert."""
    streamed: bool = False
    """Whether a part of the pixels can be read without the others."""
    unit: str | None = None
    """The unit that is named; None where none is."""


def form_of(path: Path) -> str | None:
    """Return the format of a file by its content; None for any other."""
    head = _head(path, 352)
    if head.startswith(b"NRRD000"):
        return "NRRD"
    if re.match(rb"\s*(ObjectType|NDims|Comment)\s*=", head):
        return "MetaImage"
    if len(head) >= 348 and head[344:347] in {b"n+1", b"ni1", b"n+2"}:
        return "NIfTI"
    if len(head) >= 12 and head[4:8] in {b"n+2\0", b"ni2\0"}:
        return "NIfTI"
    return None


def read_header(path: Path) -> ItkHeader:
    """Return what the file says of itself.

    Raises
    ------
    InputError
        None of the three formats, or a unit that is no length.
    """
    form = form_of(path)
    if form is None:
        raise InputError(
            "is no NRRD, MetaImage or NIfTI file" if path.exists() else "does not exist",
            where=str(path),
            found="an empty file" if path.is_file() and not path.stat().st_size else None,
        )
    head = _head(path, _HEAD)
    return {"NRRD": _nrrd, "MetaImage": _meta_image, "NIfTI": _nifti}[form](head, path)


def _nrrd(head: bytes, path: Path) -> ItkHeader:
    text = head.split(b"\n\n")[0].split(b"\r\n\r\n")[0].decode("latin-1").lower()
    fields = dict(re.findall(r"(?m)^([a-z ]+?)\s*:\s*(.*?)\s*$", text))
    spaced = bool(re.search(r"\(", fields.get("space directions", ""))) or (
        "spacings" in fields and "nan" not in fields["spacings"]
    )
    units = {unit for unit in re.findall(r'"([^"]*)"', fields.get("space units", "")) if unit}
    factor, unit = _factor(units, path)
    return ItkHeader("NRRD", spaced, factor, fields.get("encoding") == "raw", unit)


def _meta_image(head: bytes, path: Path) -> ItkHeader:  # noqa: ARG001 - one of three
    text = head.decode("latin-1")
    spaced = re.search(r"(?m)^\s*Element(Spacing|Size)\s*=", text) is not None
    packed = re.search(r"(?mi)^\s*CompressedData\s*=\s*true", text) is not None
    return ItkHeader("MetaImage", spaced, 1.0, not packed, None)


def _nifti(head: bytes, path: Path) -> ItkHeader:
    if len(head) < 348:
        raise InputError("is damaged: its header is cut off", where=str(path), found=f"{len(head)} bytes")
    second = head[4:7] == b"n+2" or head[4:7] == b"ni2"
    small = struct.unpack("<i", head[:4])[0] in {348, 540}
    order = "<" if small else ">"
    pixdim = (
        struct.unpack_from(f"{order}4d", head, 104) if second else struct.unpack_from(f"{order}4f", head, 76)
    )
    units = struct.unpack_from(f"{order}i", head, 500)[0] if second else head[123]
    return ItkHeader("NIfTI", all(side > 0 for side in pixdim[1:]), 1.0, False, _NIFTI_UNITS.get(units & 7))


def _factor(units: set[str], path: Path) -> tuple[float, str | None]:
    if not units:
        return 1.0, None
    unit = _UNIT_NAMES.get(next(iter(units)), next(iter(units)))
    if len(units) > 1 or unit not in MILLIMETRES:
        raise InputError(
            "the unit of length is not known",
            where=str(path),
            found=", ".join(sorted(units)),
            expected=", ".join(MILLIMETRES),
        )
    return MILLIMETRES[unit], unit


def _head(path: Path, size: int) -> bytes:
    try:
        with path.open("rb") as stream:
            head = stream.read(2)
        opener = gzip.open if head == b"\x1f\x8b" else open
        with opener(path, "rb") as stream:
            return bytes(stream.read(size))
    except (OSError, EOFError, gzip.BadGzipFile):
        return b""
