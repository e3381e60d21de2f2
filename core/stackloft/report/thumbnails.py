"""Small copies of the photographs, kept while the stack is decoded once."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, turn_matrix

Rgb = NDArray[np.uint8]
"""(rows, columns, 3)"""

LARGEST = 480
"""Longest side of one thumbnail, pixels."""
SMALLEST = 160
"""Longest side below which a contour can no longer be judged."""
TOTAL = 12e6
"""Pixels that all thumbnails together should not exceed."""


AROUND = 0.2
"""How much of the photograph is kept around the body, as a fraction of the body's window."""


@dataclass(frozen=True, slots=True, eq=False)
class Thumbnail:
    """The part of one slice where the body is, small."""

    name: str
    """File or slice label."""
    z: float
    """mm"""
    picture: Rgb
    per_mm: tuple[float, float]
    """Thumbnail pixels per millimetre along x and y."""
    origin: tuple[float, float]
    """Where x = 0, y = 0 lies: (column, row), thumbnail pixels, centre of the first pixel at 0."""
    turn: float = 0.0
    """rad by which the slice was turned to lie on its neighbours; the thumbnail is as the picture is."""

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height, mm."""
        rows, columns = self.picture.shape[:2]
        return columns / self.per_mm[0], rows / self.per_mm[1]

    def scaled(self, per_mm: float) -> Thumbnail:
        """Return the same thumbnail with `per_mm` pixels per millimetre, both ways but for rounding."""
        rows, columns = self.picture.shape[:2]
        width, height = (max(1, round(length * per_mm)) for length in self.extent)
        picture = resized(self.picture, (width, height))
        along = width / columns, height / rows
        return replace(
            self,
            picture=picture,
            per_mm=(self.per_mm[0] * along[0], self.per_mm[1] * along[1]),
            origin=((self.origin[0] + 0.5) * along[0] - 0.5, (self.origin[1] + 0.5) * along[1] - 0.5),
        )


class ThumbnailSink:
    """A sink (`stackloft.contracts.sink`) that keeps a thumbnail of every slice, and nothing else.

    The contours are drawn later, from what was measured. A body that is smaller than a thumbnail is
    enlarged, for a contour lies between the pixels.
    """

    def __init__(self) -> None:
        self._thumbnails: list[Thumbnail] = []

    def begin(self, segmentation: Segmentation) -> None:
        """Choose the thumbnails' size from the number of slices."""
        self._stack = segmentation.stack
        self._side = side_for(len(segmentation))

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:
        """Keep a small copy of where `picture` shows the body."""
        window = window_of(section_field, picture.shape)
        part = picture[window.top : window.bottom, window.left : window.right]
        rows, columns = part.shape[:2]
        factor = self._side / max(rows, columns)
        size = max(1, round(columns * factor)), max(1, round(rows * factor))
        along = size[0] / columns, size[1] / rows
        row_spacing, column_spacing = self._stack.pixel_spacing[index]
        turn = 0.0 if self._stack.turns is None else float(self._stack.turns[index])
        x, y = (0.0, 0.0) if self._stack.origins is None else self._stack.origins[index] @ turn_matrix(turn)
        from_left, from_top = window.left + x / column_spacing, window.top + y / row_spacing
        self._thumbnails.append(
            Thumbnail(
                self._stack.names[index],
                float(self._stack.positions[index]),
                as_rgb(resized(resizable(part), size)),
                (along[0] / column_spacing, along[1] / row_spacing),
                ((0.5 - from_left) * along[0] - 0.5, (0.5 - from_top) * along[1] - 0.5),
                turn,
            )
        )

    def end(self) -> tuple[Thumbnail, ...]:
        """Return the thumbnails in slice order."""
        return tuple(self._thumbnails)


class Window(NamedTuple):
    """A part of a picture, pixels."""

    top: int
    left: int
    bottom: int
    right: int


def window_of(section_field: SectionField, shape: tuple[int, ...]) -> Window:
    """Return the field's window with its surroundings, within the picture."""
    top, left = section_field.offset
    rows, columns = section_field.values.shape
    above, beside = math.ceil(AROUND * rows), math.ceil(AROUND * columns)
    return Window(
        max(0, top - above),
        max(0, left - beside),
        min(shape[0], top + rows + above),
        min(shape[1], left + columns + beside),
    )


def resized(picture: Picture, size: tuple[int, int]) -> Picture:
    """Return `picture` as (columns, rows) = `size`: averaged where it shrinks, interpolated elsewhere."""
    shrinks = size[0] < picture.shape[1]
    small: Picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA if shrinks else cv2.INTER_LINEAR)
    return small


def side_for(count: int) -> int:
    """Return the longest side, pixels, that keeps `count` thumbnails within `TOTAL` and legible."""
    return int(min(LARGEST, max(SMALLEST, math.sqrt(TOTAL / max(count, 1)))))


def resizable(picture: Picture) -> Picture:
    """Return `picture` in a dtype that cv2 averages: 8 or 16 bit as it is, all else as float32."""
    return (
        picture if picture.dtype in {np.dtype(np.uint8), np.dtype(np.uint16)} else picture.astype(np.float32)
    )


def as_rgb(picture: Picture) -> Rgb:
    """Return `picture` as 8-bit RGB; anything but 8-bit is stretched from its least to its greatest value.

    Examples
    --------
    >>> as_rgb(np.array([[0, 1000], [500, 1000]], dtype=np.uint16))[..., 0].tolist()
    [[0, 255], [127, 255]]
    """
    if picture.dtype != np.uint8:
        values = np.nan_to_num(picture.astype(np.float64))
        low, high = float(values.min()), float(values.max())
        picture = ((values - low) * (255.0 / (high - low) if high > low else 0.0)).astype(np.uint8)
    if picture.ndim == 2:
        picture = np.repeat(picture[..., np.newaxis], 3, axis=2)
    return np.array(picture[..., :3])
