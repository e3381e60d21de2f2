"""The pixels of a picture that Pillow has decoded, as an array of their own."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

_AT_ONCE = 500_000
"""Pixels taken over at once, few enough to stay in the processor's cache."""


def pixels_of(image: Image.Image, paper: int) -> NDArray[Any]:
    """Return the pixels as they are stored: (rows, columns) grey or (rows, columns, 3) RGB.

    Parameters
    ----------
    image : PIL.Image.Image
        Loaded.
    paper : int
        Grey level that what is transparent is laid on.

    Examples
    --------
    >>> pixels_of(Image.new("LA", (4, 3), (10, 0)), 255).tolist()[0]
    [255, 255, 255, 255]
    """
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
    pixels = np.empty((rows, columns, 3) if image.mode == "RGB" else (rows, columns), np.uint8)
    if image.mode == "L" and _pasted(image, pixels):
        return pixels
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


def _pasted(image: Image.Image, pixels: NDArray[np.uint8]) -> bool:
    """Copy a grey picture into `pixels`, a tenth of the time; return whether it has come there."""
    canvas = Image.frombuffer("L", image.size, pixels, "raw", "L", 0, 1)  # one that lies in this memory
    canvas.readonly = 0
    pixels[-1] = ~np.asarray(image.crop((0, image.size[1] - 1, *image.size)))[0]
    canvas.paste(image)
    return bool((pixels[-1] == np.asarray(image.crop((0, image.size[1] - 1, *image.size)))[0]).all())
