"""What a picture file says about its making: resolution, camera, colour profile."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from typing import Any

from PIL import Image, ImageCms

_EXIF_IFD, _MODEL, _FOCAL_LENGTH, _SUBJECT_DISTANCE = 0x8769, 0x0110, 0x920A, 0x9206
_UNREADABLE = (OSError, SyntaxError, ValueError, TypeError, IndexError, KeyError, EOFError, ZeroDivisionError)
_BROKEN_PROFILE = "unreadable"


@dataclass(frozen=True, slots=True)
class PictureTags:
    """A file's metadata, as far as they bear on measuring."""

    dpi: tuple[float, float] | None = None
    """Pixels per inch across and down, as the file's own pixels lie; None when it does not say."""
    by_camera: bool = False
    """True when a lens took it: its EXIF has a focal length or a camera's model."""
    subject_distance: float | None = None
    """mm, when the camera wrote it"""
    profile: str | None = None
    """Name of its colour profile (ICC)."""


def read_tags(image: Image.Image) -> PictureTags:
    """Return the tags of an opened picture; broken ones count as missing.

    Examples
    --------
    >>> stream = io.BytesIO()
    >>> Image.new("L", (8, 8)).save(stream, "TIFF", dpi=(300, 300))
    >>> read_tags(Image.open(stream)).dpi
    (300.0, 300.0)
    """
    try:
        exif = image.getexif()
        photo: dict[int, Any] = dict(exif.get_ifd(_EXIF_IFD))
        by_camera = _positive(photo.get(_FOCAL_LENGTH)) is not None or bool(exif.get(_MODEL))
    except _UNREADABLE:
        photo, by_camera = {}, False
    distance = _positive(photo.get(_SUBJECT_DISTANCE))
    return PictureTags(_dpi(image), by_camera, 1000 * distance if distance else None, _profile(image))


def _positive(value: Any) -> float | None:
    try:
        number = float(value)
    except _UNREADABLE:
        return None
    return number if math.isfinite(number) and number > 0 else None


def _dpi(image: Image.Image) -> tuple[float, float] | None:
    said = image.info.get("dpi")
    if not isinstance(said, tuple) or len(said) != 2:
        return None
    across, down = _positive(said[0]), _positive(said[1])
    return None if across is None or down is None or min(across, down) <= 1 else (across, down)


def _profile(image: Image.Image) -> str | None:
    content = image.info.get("icc_profile")
    if not content:
        return None
    try:
        return str(ImageCms.getProfileDescription(ImageCms.ImageCmsProfile(io.BytesIO(content)))).strip()
    except (*_UNREADABLE, ImageCms.PyCMSError):
        return _BROKEN_PROFILE
