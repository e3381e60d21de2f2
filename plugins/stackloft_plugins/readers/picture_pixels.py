"""The pixels of a picture that Pillow decodes, as an array of their own."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageFile

from stackloft.model.reused_memory import empty

_AT_ONCE = 500_000
"""Pixels taken over at once, few enough to stay in the processor's cache."""


def loaded_pixels(image: Image.Image, paper: int) -> NDArray[Any]:
    """Load a picture and return its pixels as they are stored: (rows, columns) or (rows, columns, 3), RGB.

    8-bit grey is decoded into the array itself: a copy of it would take a tenth of the time, and the memory.

    Parameters
    ----------
    image : PIL.Image.Image
    paper : int
        Grey level that what is transparent is laid on.

    Examples
    --------
    >>> loaded_pixels(Image.new("LA", (4, 3), (10, 0)), 255).tolist()[0]
    [255, 255, 255, 255]
    """
    if image.mode != "L" or image.has_transparency_data or not isinstance(image, ImageFile.ImageFile):
        image.load()
        return _pixels_of(image, paper)
    pixels: NDArray[Any] = empty(image.size[::-1], np.uint8)
    canvas = Image.frombuffer("L", image.size, pixels, "raw", "L", 0, 1).im  # it lies in this memory
    image.im = canvas
    image.load()
    return pixels if image.im is canvas else _pixels_of(image, paper)  # Pillow may have had another idea


def _pixels_of(image: Image.Image, paper: int) -> NDArray[Any]:
    if image.mode in {"F", "I"} or image.mode.startswith("I;16"):
        deep = np.asarray(image)
        return deep.astype(deep.dtype.newbyteorder("="))
    if image.has_transparency_data:
        return _composited(image, paper)
    return _unpacked(
        image if image.mode in {"L", "RGB"} else image.convert("L" if image.mode == "1" else "RGB")
    )


def _unpacked(image: Image.Image) -> NDArray[np.uint8]:
    """Return the pixels of an 8-bit picture, some rows at once: Pillow's own way copies them thrice."""
    columns, rows = image.size
    pixels = empty((rows, columns, 3) if image.mode == "RGB" else (rows, columns), np.uint8)
    step = max(1, _AT_ONCE // columns)
    for top in range(0, rows, step):
        bottom = min(top + step, rows)
        pixels[top:bottom] = np.asarray(image.crop((0, top, columns, bottom)))
    return pixels


def _composited(image: Image.Image, paper: int) -> NDArray[Any]:
    """Lay what is transparent on paper; opaque pictures lose nothing."""
    layered = image.convert("LA" if image.mode in {"LA", "La"} else "RGBA")
    values = np.asarray(layered)
    colour, alpha = values[..., :-1], values[..., -1:]
    if (alpha == 255).all():
        return np.ascontiguousarray(colour[..., 0] if colour.shape[-1] == 1 else colour)
    weight = alpha.astype(np.float32) / 255
    laid = np.rint(colour * weight + paper * (1 - weight)).astype(np.uint8)
    return np.ascontiguousarray(laid[..., 0] if laid.shape[-1] == 1 else laid)
