"""What a file is, by its first bytes: suffixes lie, contents do not."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path

READABLE = ("JPEG", "PNG", "TIFF", "BMP", "WEBP")
"""Picture formats that are measured, by Pillow's names."""

_SIGNATURES = (
    ("JPEG", 0, b"\xff\xd8\xff"),
    ("PNG", 0, b"\x89PNG\r\n\x1a\n"),
    ("TIFF", 0, b"II*\x00"),
    ("TIFF", 0, b"MM\x00*"),
    ("TIFF", 0, b"II+\x00"),
    ("TIFF", 0, b"MM\x00+"),
    ("GIF", 0, b"GIF8"),
    ("JPEG 2000", 0, b"\x00\x00\x00\x0cjP  "),
    ("PSD", 0, b"8BPS"),
)
_HEIF_BRANDS = (b"heic", b"heix", b"hevc", b"heim", b"heis", b"mif1", b"msf1")
_AVIF_BRANDS = (b"avif", b"avis")

SUFFIXES = frozenset(
    {
        *(".jpg", ".jpeg", ".jpe", ".jfif", ".png", ".tif", ".tiff", ".bmp", ".dib", ".webp"),
        *(".gif", ".heic", ".heif", ".avif", ".jp2", ".psd"),
    }
)
"""Suffixes that promise a picture: such a file that is none is an error, any other is passed over."""

_HEAD = 32
_DIGITS = re.compile(r"(\d+)")


def picture_kind(path: Path) -> str | None:
    """Return the picture format of a file by its first bytes; None when it is no picture.

    Raises
    ------
    OSError
        The file cannot be opened.
    """
    with path.open("rb") as stream:
        return kind_of_bytes(stream.read(_HEAD))


def kind_of_bytes(head: bytes) -> str | None:
    r"""Return the picture format that begins with `head` (32 bytes suffice).

    Examples
    --------
    >>> kind_of_bytes(b"RIFF\x00\x00\x00\x00WEBPVP8 "), kind_of_bytes(b"section,z,loop")
    ('WEBP', None)
    """
    for kind, start, signature in _SIGNATURES:
        if head[start : start + len(signature)] == signature:
            return kind
    if head[:4] == b"RIFF" and head[8:12] == b"WEBP":
        return "WEBP"
    if head[:2] == b"BM" and head[6:10] == b"\0\0\0\0":
        return "BMP"
    if head[4:8] == b"ftyp":
        brand = head[8:12]
        return "HEIC" if brand in _HEIF_BRANDS else "AVIF" if brand in _AVIF_BRANDS else None
    return None


@lru_cache(maxsize=8192)
def natural_key(name: str) -> tuple[tuple[str | int, ...], str]:
    """Return a sort key that reads digits as numbers.

    Examples
    --------
    >>> sorted(["slice_10.png", "Slice_9.png", "slice_2.png"], key=natural_key)
    ['slice_2.png', 'Slice_9.png', 'slice_10.png']
    """
    parts = _DIGITS.split(name.casefold())
    return tuple(int(part) if odd % 2 else part for odd, part in enumerate(parts)), name
