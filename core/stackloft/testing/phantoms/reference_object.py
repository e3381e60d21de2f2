"""An object of known size in a corner of the picture: a coin, a square, a piece of ruler.

::

    +--------------------+
    | (o)                |    corner 0 top left, 1 top right, 2 bottom right, 3 bottom left
    |      +------+      |
    |      | body |      |
    |      +------+      |
    +--------------------+
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import UsageError
from stackloft.model.lengths import parse_length
from stackloft.testing.phantoms.frame import Frame

Kind = Literal["disc", "square", "ruler"]
KINDS: tuple[Kind, ...] = ("disc", "square", "ruler")
GREY = 120.0
"""Grey level in noise-free pictures, of 255."""
_COLOURS = {"disc": (150.0, 128.0, 104.0), "square": (52.0, 98.0, 172.0), "ruler": (150.0, 152.0, 156.0)}
_RULER_WIDTH = 0.22  # of its length
_OUTLINE = 720  # points on a disc: its polygon is short by 1.3e-5 in area


@dataclass(frozen=True, slots=True)
class ReferenceObject:
    """The object, and where it lies.

    Examples
    --------
    >>> ReferenceObject.parse("disc:24.25mm").size
    24.25
    """

    kind: Kind
    size: float
    """mm: a disc's diameter, a square's side, a ruler segment's length"""
    corner: int = 0
    """0 to 3, clockwise from the top left"""
    angle: float = 0.0
    """Degrees by which it is turned."""
    gap: float = 4.0
    """mm between it and the picture's edges; negative cuts it off"""
    height: float = 0.0
    """mm above the cut face, negative below it"""
    stays: bool = False
    """True: it stays at that height from the first face while the faces recede."""
    pictures: Literal["every", "first"] = "every"

    def __post_init__(self) -> None:
        if self.kind not in KINDS or not self.size > 0 or self.corner not in range(4):
            raise UsageError(
                "no such reference object", where="reference",
                found=f"{self.kind}:{self.size:g}mm in corner {self.corner}",
                expected="disc, square or ruler, a positive size, a corner from 0 to 3",
            )  # fmt: skip

    @classmethod
    def parse(cls, text: str) -> ReferenceObject:
        """Return the object written as ``disc|square|ruler:LEN``."""
        name, _, size = text.partition(":")
        kind = next((known for known in KINDS if known == name), None)
        if kind is None or not size:
            raise UsageError(
                "no such reference object", where="reference", found=repr(text), expected="disc:24.25mm"
            )
        return cls(kind, parse_length(size, "reference"))

    def shown(self, index: int) -> bool:
        """Tell whether picture `index`, counted from 1, shows it."""
        return self.pictures == "every" or index == 1

    def outline(self) -> FloatArray:
        """Return its outline about the origin, (k, 2) mm, counter-clockwise."""
        if self.kind == "disc":
            t = 2 * np.pi * np.arange(_OUTLINE) / _OUTLINE
            return 0.5 * self.size * np.column_stack([np.cos(t), np.sin(t)])
        half = 0.5 * self.size * np.array([1.0, 1.0 if self.kind == "square" else _RULER_WIDTH])
        c, s = np.cos(np.radians(self.angle)), np.sin(np.radians(self.angle))
        corners = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]]) * half
        turned: FloatArray = corners @ np.array([[c, s], [-s, c]])
        return turned

    def room(self) -> tuple[float, float]:
        """Return half its width and height as it lies, mm."""
        half = np.abs(self.outline()).max(axis=0)
        return float(half[0]), float(half[1])

    def widened(self, frame: Frame) -> Frame:
        """Return the frame with enough plate at the side of its corner."""
        extra = round((2 * self.room()[0] + max(self.gap, 0) + 2) / frame.pixel_size)
        shift = extra * frame.pixel_size if self.corner in {0, 3} else 0.0
        rows, columns = frame.shape
        need = round((2 * self.room()[1] + 2 * max(self.gap, 0)) / frame.pixel_size) + 1
        return Frame(
            frame.matrix, frame.origin - [shift, 0], (max(rows, need), columns + extra), frame.pixel_size
        )

    def polygon(self, shape: tuple[int, int], pixel_size: float) -> FloatArray:
        """Return its outline in pixels whose cells are [j, j+1] × [i, i+1], at its own plane's pixel size."""
        inset = (np.array(self.room()) + self.gap) / pixel_size
        right, bottom = self.corner in {1, 2}, self.corner in {2, 3}
        centre = np.array([
            shape[1] - inset[0] if right else inset[0], shape[0] - inset[1] if bottom else inset[1]
        ])  # fmt: skip
        outline: FloatArray = centre + self.outline() / pixel_size
        return outline

    def colours(self, shape: tuple[int, int], pixel_size: float) -> FloatArray:
        """Return its colour at every pixel, (3, rows, columns): a rim and relief, or a scale's ticks."""
        colour = np.array(_COLOURS[self.kind])[:, None, None] * np.ones((1, *shape))
        middle = self.polygon(shape, pixel_size).mean(axis=0)
        y, x = np.meshgrid(*((np.arange(n) + 0.5) * pixel_size for n in shape), indexing="ij")
        x, y = x - middle[0] * pixel_size, y - middle[1] * pixel_size
        if self.kind == "disc":
            across = np.hypot(x, y) / (0.5 * self.size)
            embossed = 14 * np.sin(5 * np.arctan2(y, x)) * np.sin(9 * across) * (across < 0.8)
            return np.asarray(colour + embossed - 10 * (np.abs(across - 0.84) < 0.03))
        if self.kind == "ruler":
            c, s = np.cos(np.radians(self.angle)), np.sin(np.radians(self.angle))
            along, aside = x * c + y * s, y * c - x * s
            inside = (np.abs(along) < 0.5 * self.size - 2) & (aside > 0) & (aside < 0.07 * self.size)
            return np.asarray(colour - 80 * (inside & (np.mod(along, 2.0) < 0.5)))
        return np.asarray(colour)
