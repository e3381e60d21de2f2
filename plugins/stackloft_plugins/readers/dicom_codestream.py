"""Whether a file's pixel data are all there, and of the size that the header claims, before decoding.

A decoder makes room for what a codestream's own header claims, and fills what is cut off with grey;
both are looked at here, marker by marker, without decoding anything.
"""

from __future__ import annotations

import struct

from stackloft.model.errors import InputError
from stackloft_plugins.readers.dicom_file import DEFLATED, ClampedFile, read_elements
from stackloft_plugins.readers.dicom_frame import Frame

PIXELS = b"\xe0\x7f\x10\x00"
"""The pixel data element's tag, little endian."""
_ITEM, _END = b"\xfe\xff\x00\xe0", b"\xfe\xff\xdd\xe0"
_UNDEFINED = 0xFFFFFFFF
_SIZED = frozenset({*range(0xC0, 0xD0), 0xF7}) - {0xC4, 0xC8, 0xCC}
"""JPEG markers with the frame's size: SOF0 … SOF15, and SOF55 of JPEG-LS."""
_HEAD = 1 << 16
RLE = "1.2.840.10008.1.2.5"
_RLE_GAIN = 64
"""PackBits turns at most two bytes into 128."""


def check_codestream(stream: ClampedFile, frame: Frame) -> None:
    """Refuse compressed pixels that are cut off or of another size than the header claims.

    Raises
    ------
    InputError
        The file is named, with what was found and expected.
    """
    if frame.syntax == DEFLATED or not _compressed(frame.syntax):
        return
    read_elements(stream, ("Rows",))
    tag, length = stream.read(4), struct.unpack("<8xI", b"\0\0\0\0" + stream.read(8))[0]
    if tag != PIXELS or length != _UNDEFINED:
        raise _damaged(frame, "no compressed pixel data", "pixel data in fragments")
    fragments = _fragments(stream, frame)
    if not fragments:
        raise _damaged(frame, "no fragment", "at least one")
    sizes = sum(size for _, size in fragments)
    if frame.syntax == RLE:
        need = frame.shape[0] * frame.shape[1] * frame.samples
        if need > _RLE_GAIN * sizes:
            raise _damaged(frame, f"{sizes} bytes", f"enough for {need} samples")
        return
    stream.seek(fragments[0][0])
    claimed = codestream_size(stream.read(min(fragments[0][1], _HEAD)))
    if claimed is not None and claimed != frame.shape:
        raise _damaged(frame, "a codestream of {} × {}".format(*claimed), "{} × {}".format(*frame.shape))
    start, size = fragments[-1]
    stream.seek(start + max(0, size - 4))
    if b"\xff\xd9" not in stream.read(4):
        raise _damaged(frame, "a codestream without its end", "an end-of-image marker")


def codestream_size(head: bytes) -> tuple[int, int] | None:
    """Return (rows, columns) that a JPEG, JPEG-LS or JPEG 2000 codestream claims; None when it says none.

    Examples
    --------
    >>> codestream_size(bytes.fromhex("ffd8ffc0000b080010002001ffffff"))
    (16, 32)
    """
    if head[:4] == b"\xff\x4f\xff\x51":
        across, down, left, top = struct.unpack_from(">4I", head, 8)
        return down - top, across - left
    place = 2
    while place + 9 <= len(head) and head[place] == 0xFF:
        marker = head[place + 1]
        if marker in _SIZED:
            rows, columns = struct.unpack_from(">HH", head, place + 5)
            return int(rows), int(columns)
        if marker == 0xFF:
            place += 1
            continue
        place += 2 + int(struct.unpack_from(">H", head, place + 2)[0])
    return None


def _fragments(stream: ClampedFile, frame: Frame) -> list[tuple[int, int]]:
    """Return start and size of every fragment after the offset table."""
    found: list[tuple[int, int]] = []
    while True:
        head = stream.read(8)
        if head[:4] == _END:
            return found[1:]
        if len(head) < 8 or head[:4] != _ITEM:
            raise _damaged(frame, "pixel data that are cut off or broken", "fragments up to a delimiter")
        (size,) = struct.unpack("<I", head[4:])
        start = stream.tell()
        if start + size > stream.size:
            raise _damaged(frame, f"{stream.size - start} bytes of a fragment", f"{size} bytes")
        found.append((start, size))
        stream.seek(start + size)


def _compressed(syntax: str) -> bool:
    from pydicom.uid import UID  # noqa: PLC0415 - slow to import

    named = UID(syntax)
    return bool(named.is_transfer_syntax and named.is_compressed and named.is_encapsulated)


def _damaged(frame: Frame, found: str, expected: str) -> InputError:
    return InputError(
        f"is damaged: the picture of {frame.name} cannot be read",
        where=str(frame.path),
        found=found,
        expected=expected,
        fix="copy it again from the scanner",
    )
