"""What the picture sheets share: colours, text, a scale bar of a round length."""

from __future__ import annotations

import math
from functools import cache

from PIL import ImageDraw, ImageFont

PAPER = (250, 250, 250)
MOUNT = (232, 232, 232)
INK = (40, 40, 40)
FAINT = (120, 120, 120)

Font = ImageFont.FreeTypeFont | ImageFont.ImageFont
_ROUND = (1.0, 2.0, 5.0)


@cache
def font(size: int) -> Font:
    """Return Pillow's own font, which needs no file of the system."""
    return ImageFont.load_default(size=size)


def line_height(face: Font) -> int:
    """Return the distance of two lines of text, pixels."""
    return math.ceil(face.getbbox("Åg")[3]) + 2


def shortened(text: str, face: Font, width: int) -> str:
    """Return `text`, its middle left out when it is wider than `width` pixels."""
    keep = len(text)
    short = text
    while face.getbbox(short)[2] > width and keep > 4:
        keep -= 1
        short = f"{text[: keep // 2]}…{text[len(text) - keep // 2 :]}"
    return short


def round_length(most: float) -> float:
    """Return the greatest of 1, 2, 5, 10, 20 … (and 0.5, 0.2 …) that is not above `most`.

    Examples
    --------
    >>> [round_length(most) for most in (37.0, 9.9, 0.3)]
    [20.0, 5.0, 0.2]
    """
    decade = 10.0 ** math.floor(math.log10(most))
    return max(step * decade for step in _ROUND if step * decade <= most * (1 + 1e-9))


def length_label(length: float) -> str:
    """Return a length of `round_length` in the unit that makes it a plain number.

    Examples
    --------
    >>> [length_label(x) for x in (50.0, 5.0, 0.02)]
    ['5 cm', '5 mm', '20 µm']
    """
    if length >= 10.0:
        return f"{length / 10:g} cm"
    return f"{length:g} mm" if length >= 0.1 else f"{length * 1000:g} µm"


def draw_scale_bar(
    draw: ImageDraw.ImageDraw,
    at: tuple[int, int],
    per_mm: float,
    room: float,
    face: Font,
    *,
    dark: bool = False,
) -> float:
    """Draw a bar of a round length with its label above; return its length, mm.

    Parameters
    ----------
    draw : ImageDraw
    at : tuple of int
        Left end of the bar's foot, pixels.
    per_mm : float
        Pixels per millimetre.
    room : float
        Pixels that the bar may be long.
    face : Font
    dark : bool
        Dark on a light ground; else white with a black edge, which is seen on any photograph.
    """
    length = round_length(room / per_mm)
    left, foot = at
    right, thick = left + round(length * per_mm), 4
    above = left, foot - thick - line_height(face) - 2
    label = length_label(length)
    if dark:
        draw.rectangle((left, foot - thick + 1, right, foot), fill=INK)
        draw.text(above, label, fill=INK, font=face)
        return length
    draw.rectangle((left - 1, foot - thick - 1, right + 1, foot + 1), fill=(0, 0, 0))
    draw.rectangle((left, foot - thick, right, foot), fill=(255, 255, 255))
    draw.text(above, label, fill=(255, 255, 255), font=face, stroke_width=1, stroke_fill=(0, 0, 0))
    return length
