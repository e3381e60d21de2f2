"""One picture file: its header, and its pixels when they are asked for (Pillow)."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from stackloft.model.errors import InputError
from stackloft_plugins.readers.picture_kinds import READABLE
from stackloft_plugins.readers.picture_pixels import loaded_pixels
from stackloft_plugins.readers.picture_tags import PictureTags, read_tags

MAX_PIXELS = 500_000_000
"""Larger pictures are taken for decompression bombs."""

MIN_SIDE = 3
"""A smaller picture has no inside."""

_PILLOW_LIMIT = 80_000_000  # below the size at which Pillow itself warns


_DAMAGE = (OSError, SyntaxError, ValueError, TypeError, IndexError, KeyError, EOFError, MemoryError)
"""What Pillow raises on damaged files."""

_Turn = Callable[[NDArray[Any]], NDArray[Any]]
_UPRIGHT: dict[int, _Turn] = {
    2: lambda a: a[:, ::-1],
    3: lambda a: a[::-1, ::-1],
    4: lambda a: a[::-1],
    5: lambda a: a.swapaxes(0, 1),
    6: lambda a: a.swapaxes(0, 1)[:, ::-1],
    7: lambda a: a.swapaxes(0, 1)[::-1, ::-1],
    8: lambda a: a.swapaxes(0, 1)[::-1],
}
"""What undoes each EXIF orientation (TIFF 6.0, tag 274)."""

_lock = threading.Lock()


@dataclass(frozen=True, slots=True)
class PictureHeader:
    """What the header of a picture says."""

    path: Path
    size: tuple[int, int]
    """(rows, columns) as seen upright"""
    orientation: int = 1
    """EXIF orientation, 1 to 8"""
    tags: PictureTags = field(default_factory=PictureTags)
    """What the file says about its making."""
    delicate: bool = False
    """True when opening it needs Pillow's warnings or its own size limit put aside."""


def read_header(path: Path) -> PictureHeader:
    """Return a picture's header; no pixel is decoded.

    Raises
    ------
    InputError
        Damaged, empty, animated or multi-page, or too large.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     Image.new("L", (40, 30)).save(Path(folder) / "a.png")
    ...     read_header(Path(folder) / "a.png").size
    (30, 40)
    """
    with _delicately() as caught, _opened(path) as image:
        orientation = _orientation(image)
        columns, rows = image.size
        tags = read_tags(image)
        _check_pages(image, path)
    if rows * columns > MAX_PIXELS:
        raise InputError(
            "picture is too large; it may be a decompression bomb",
            where=str(path),
            found=f"{columns} × {rows} pixels",
            expected=f"at most {MAX_PIXELS // 1_000_000} Mpx",
            fix="scale the pictures down, all by the same factor",
        )
    if min(rows, columns) < MIN_SIDE:
        raise InputError("picture is too small", where=str(path), found=f"{columns} × {rows} pixels")
    size = (columns, rows) if orientation >= 5 else (rows, columns)
    return PictureHeader(path, size, orientation, tags, bool(caught) or rows * columns > _PILLOW_LIMIT)


def decode_picture(header: PictureHeader, paper: int = 255, *, luminance: bool = False) -> NDArray[Any]:
    """Return the upright pixels, in an array of their own: (rows, columns) grey or (rows, columns, 3) RGB.

    8-bit grey and colour come as uint8, 16-bit grey as uint16, 32-bit grey as int32 or float32.
    Palettes become RGB, CMYK and other colour models are converted to RGB, and what is transparent is
    laid on a paper of grey level `paper`. Safe to call from several threads.

    With `luminance`, a colour JPEG gives the luminance (ITU-R BT.601) that is stored beside its colours
    (JFIF), which takes less than half the time and a third of the memory.

    Raises
    ------
    InputError
        The picture is truncated or damaged, or has changed since its header was read.
    """
    pixels = _decoded(header, paper, (lambda image: image.draft("L", None)) if luminance else None)
    _check_size(header, pixels, header.size)
    return pixels


def decode_smaller(header: PictureHeader, paper: int, longest: int) -> tuple[NDArray[Any], int]:
    """Return the pixels of a copy half, a quarter or an eighth as large, and by how much it is smaller.

    JPEG is decoded so in the first place (fewer frequencies of its cosine transforms are used), in a fraction
    of the time; other formats come whole. A copy's pixel covers 2², 4² or 8² of the picture's.

    Parameters
    ----------
    header, paper
        As for `decode_picture`, errors likewise.
    longest : int
        The copy's longer side has at least so many pixels, unless the picture has fewer.
    """
    factor = next((f for f in (8, 4, 2) if max(header.size) >= f * longest), 1)

    def reduce(image: Image.Image) -> None:
        image.draft(image.mode, (image.size[0] // factor, image.size[1] // factor))

    pixels = _decoded(header, paper, reduce if factor > 1 else None)
    if pixels.shape[:2] == header.size:
        return pixels, 1
    _check_size(header, pixels, (-(-header.size[0] // factor), -(-header.size[1] // factor)))
    return pixels, factor


def _decoded(
    header: PictureHeader, paper: int, prepare: Callable[[Image.Image], object] | None
) -> NDArray[Any]:
    with _delicately() if header.delicate else nullcontext(), _opened(header.path) as image:
        try:
            if prepare is not None:
                prepare(image)  # does something to JPEG alone
            pixels = loaded_pixels(image, paper)
        except _DAMAGE as error:
            raise _damaged(header.path, error) from error
    return np.ascontiguousarray(_UPRIGHT[header.orientation](pixels)) if header.orientation != 1 else pixels


def _check_size(header: PictureHeader, pixels: NDArray[Any], size: tuple[int, int]) -> None:
    if pixels.shape[:2] != size:
        raise InputError(
            "picture changed while it was read",
            where=str(header.path),
            found=f"{pixels.shape[1]} × {pixels.shape[0]} pixels",
            expected=f"{size[1]} × {size[0]}",
        )


@contextmanager
def _delicately() -> Iterator[list[warnings.WarningMessage]]:
    """Put Pillow's size limit and its warnings about metadata aside, and gather the latter.

    Both are global to the process, hence the lock; decoding enters here only for files that need it.
    """
    with _lock, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        limit, Image.MAX_IMAGE_PIXELS = Image.MAX_IMAGE_PIXELS, None
        try:
            yield caught
        finally:
            Image.MAX_IMAGE_PIXELS = limit


@contextmanager
def _opened(path: Path) -> Iterator[Image.Image]:
    try:
        image = Image.open(path, formats=(*READABLE, "MPO"))
    except _DAMAGE as error:
        raise _damaged(path, error) from error
    with image:
        yield image


def _orientation(image: Image.Image) -> int:
    try:
        value = image.getexif().get(0x0112, 1)
    except (*_DAMAGE, ZeroDivisionError):
        return 1  # unreadable EXIF: the pixels themselves may be sound
    return value if isinstance(value, int) and 1 <= value <= 8 else 1


def _check_pages(image: Image.Image, path: Path) -> None:
    if image.format == "MPO":
        return  # a phone's JPEG with a preview or gain map behind the photograph
    try:
        pages = getattr(image, "n_frames", 1)
    except _DAMAGE as error:
        raise _damaged(path, error) from error
    if pages > 1:
        raise InputError(
            "picture has several pages or frames",
            where=str(path),
            found=f"{pages} frames ({image.format})",
            expected="one picture per file",
            fix=f"split it: magick {path.name} slice_%03d.png",
        )


def _damaged(path: Path, error: BaseException) -> InputError:
    reason = str(error).replace(str(path), path.name) or type(error).__name__
    if isinstance(error, UnidentifiedImageError):
        reason = "its header cannot be read"
    return InputError(
        "picture is damaged or truncated",
        where=str(path),
        found=reason,
        expected="a whole JPEG, PNG, TIFF, BMP or WebP picture",
        fix="copy it again from the camera, or set skip = true for it in stack.toml",
    )
