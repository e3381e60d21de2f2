"""A picture as the content of a file."""

from __future__ import annotations

import io
from typing import Any

from numpy.typing import NDArray

FORMATS = {
    "png": "PNG",
    "jpg": "JPEG",
    "jpeg": "JPEG",
    "tif": "TIFF",
    "tiff": "TIFF",
    "bmp": "BMP",
    "webp": "WEBP",
}
"""Suffix to Pillow's name of the format."""

_MAKE, _EXIF_IFD, _FOCAL_LENGTH = 0x010F, 0x8769, 0x920A


def encoded(picture: NDArray[Any], suffix: str, quality: int | None, *, by_camera: bool = False) -> bytes:
    """Return the picture as a file's content.

    Parameters
    ----------
    picture : array (rows, columns) or (rows, columns, 3)
        uint8 or uint16.
    suffix : str
        A key of `FORMATS`.
    quality : int, optional
        Of JPEG and WebP, 1 to 100; None: 95, and WebP without loss.
    by_camera : bool
        Whether the file says that a camera with a lens took it (EXIF); BMP cannot.
    """
    from PIL import Image  # noqa: PLC0415 - only where pictures are written

    form = FORMATS[suffix]
    options: dict[str, Any] = {
        "JPEG": {"quality": quality or 95, "subsampling": 0},
        "WEBP": {"quality": quality or 95, "lossless": quality is None},
    }.get(form, {})
    if by_camera and form != "BMP":
        exif = Image.Exif()
        exif[_MAKE] = "stackloft phantom"
        exif.get_ifd(_EXIF_IFD)[_FOCAL_LENGTH] = 35.0
        options["exif"] = exif
    stream = io.BytesIO()
    Image.fromarray(picture).save(stream, form, **options)
    return stream.getvalue()
