"""Small copies of the photographs, kept while the stack is decoded once."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture

Rgb = NDArray[np.uint8]
"""(rows, columns, 3)"""

LARGEST = 480
"""Longest side of one thumbnail, pixels."""
SMALLEST = 160
"""Longest side below which a contour can no longer be judged."""
TOTAL = 12e6
"""Pixels that all thumbnails together should not exceed."""


@dataclass(frozen=True, slots=True, eq=False)
class Thumbnail:
    """One slice, small."""

    name: str
    """File or slice label."""
    z: float
    """mm"""
    picture: Rgb
    per_mm: tuple[float, float]
    """Thumbnail pixels per millimetre along x and y."""
    origin: tuple[float, float]
    """Where x = 0, y = 0 lies: (column, row), thumbnail pixels, centre of the first pixel at 0."""


class ThumbnailSink:
    """A sink (`stackloft.contracts.sink`) that keeps a thumbnail of every slice, and nothing else."""

    def __init__(self) -> None:
        self._thumbnails: list[Thumbnail] = []

    def begin(self, segmentation: Segmentation) -> None:
        """Choose the thumbnails' size from the number of slices."""
        self._stack = segmentation.stack
        self._side = side_for(len(segmentation))

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:  # noqa: ARG002
        """Keep a small copy of `picture`; the contour is drawn later, from what was measured."""
        rows, columns = picture.shape[:2]
        factor = min(1.0, self._side / max(rows, columns))
        size = max(1, round(columns * factor)), max(1, round(rows * factor))
        small = cv2.resize(_resizable(picture), size, interpolation=cv2.INTER_AREA)
        row_spacing, column_spacing = self._stack.pixel_spacing[index]
        along_x, along_y = size[0] / columns, size[1] / rows
        self._thumbnails.append(
            Thumbnail(
                self._stack.names[index],
                float(self._stack.positions[index]),
                as_rgb(small),
                (along_x / column_spacing, along_y / row_spacing),
                (0.5 * along_x - 0.5, 0.5 * along_y - 0.5),
            )
        )

    def end(self) -> tuple[Thumbnail, ...]:
        """Return the thumbnails in slice order."""
        return tuple(self._thumbnails)


def side_for(count: int) -> int:
    """Return the longest side, pixels, that keeps `count` thumbnails within `TOTAL` and legible."""
    return int(min(LARGEST, max(SMALLEST, math.sqrt(TOTAL / max(count, 1)))))


def _resizable(picture: Picture) -> Picture:
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
