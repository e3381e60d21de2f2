"""What lies on the plate, and which of it has the shape of a reference object.

::

    +--------------------+     Objects are told from the plate by colour, at several thresholds, because a
    | (o)   zone         |     coin may be fainter than the body. The reference object has its shape and
    |      +------+      |     lies nearer to a corner than anything else of its size; the one object of a
    |      | body |      |     picture is never it, however round.
    |      +------+      |
    +--------------------+
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft.model.reference import ReferenceKind

LEVELS = (0.12, 0.2, 0.32, 0.5, 0.68)
"""Thresholds, as parts of the largest difference in colour from the plate."""
_FAINTEST = 12.0  # of 255
_LEAST = 6e-4  # of the picture's area
_ZONE = 0.44  # of the picture's side: the reference object's middle lies this near to one edge at least
_COMPANY = 0.04  # of the candidate's area: what else must be in the picture, for the body is never it
_BESIDE = 0.05  # of the candidate's area: smaller things may lie nearer to the corner
_NEAR_ROUND = 0.03
_NEAR_SQUARE = 0.06
_NEAR_FULL = 0.94
_RULER = (2.2, 30.0)  # length by width


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """One object of a small copy of the picture; lengths in its pixels."""

    outline: NDArray[np.int32]
    """(k, 1, 2) x, y as OpenCV has them"""
    area: float
    centre: tuple[float, float]
    """x, y"""
    to_corner: float
    """Of the centre from the nearest corner: across and down as parts of the sides, added."""
    off_middle: float
    """Of the centre from the nearest edge, as a part of that side."""
    cut_off: bool
    """True when it touches the picture's border."""

    @property
    def box(self) -> tuple[tuple[float, float], tuple[float, float], float]:
        """Middle, sides (the extent of its pixels) and angle in degrees of the smallest rectangle."""
        (x, y), (width, height), angle = cv2.minAreaRect(self.outline)
        return (x, y), (width + 1.0, height + 1.0), angle


def contrast_with_plate(picture: NDArray[Any]) -> NDArray[np.float32]:
    """Return how far each pixel's colour is from the frame's usual one, (rows, columns) on 0–255."""
    colours = np.asarray(picture if picture.ndim == 3 else picture[..., None], dtype=np.float32)
    if picture.dtype != np.uint8:
        low, high = (float(value) for value in np.percentile(colours, (0.1, 99.9)))
        colours = (colours - low) * np.float32(255.0 / max(high - low, 1e-9))
    width = max(1, round(0.02 * min(colours.shape[:2])))
    edges = (colours[:width], colours[-width:], colours[:, :width], colours[:, -width:])
    plate = np.median(np.concatenate([edge.reshape(-1, colours.shape[2]) for edge in edges]), axis=0)
    total = np.zeros(colours.shape[:2], np.float32)
    for k in range(colours.shape[2]):  # plane by plane: a tenth of the time
        off = np.subtract(cv2.extractChannel(colours, k), plate[k], dtype=np.float32)
        total += np.square(off, out=off)
    return np.asarray(np.sqrt(total / np.float32(colours.shape[2])), dtype=np.float32)


def greatest(contrast: NDArray[np.float32]) -> float:
    """Return the contrast that little of the picture exceeds."""
    return float(np.percentile(contrast, 99.5))


def shapes_at(contrast: NDArray[np.float32], level: float, least: float | None = None) -> list[Shape]:
    """Return the objects that stand out by more than a contrast, and by more than plates scatter.

    Smaller ones than `least` pixels are left out; None: than a part of the picture.
    """
    level = max(_FAINTEST, level)
    rows, columns = contrast.shape
    mask = (contrast > level).astype(np.uint8)
    outlines, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    shapes = []
    for outline in outlines:
        area = cv2.contourArea(outline) + 0.5 * len(outline) + 1.0  # the pixels, not their middles
        if area < (_LEAST * contrast.size if least is None else least):
            continue
        x, y, width, height = cv2.boundingRect(outline)
        middle = (x + (width - 1) / 2, y + (height - 1) / 2)
        across, down = (min(at, 1 - at) for at in ((middle[0] + 0.5) / columns, (middle[1] + 0.5) / rows))
        cut_off = x == 0 or y == 0 or x + width == columns or y + height == rows
        shapes.append(Shape(np.asarray(outline), area, middle, across + down, min(across, down), cut_off))
    return shapes


def has_shape(shape: Shape, kind: ReferenceKind) -> bool:
    """Tell whether an object, seen whole, is round, square or a straight bar as far as pixels show."""
    if shape.cut_off:
        return False
    _, (width, height), _ = shape.box
    short, long = sorted((width, height))
    if short < 4:
        return False
    if kind is ReferenceKind.DISC:
        return _roundness(shape.outline) < _NEAR_ROUND + 0.5 / short
    # a turned side runs through pixels, of which those half covered may be missing
    full = shape.area / (width * height) > _NEAR_FULL - 1.2 / short
    aspect = long / short
    if kind is ReferenceKind.SQUARE:
        return full and aspect < 1 + _NEAR_SQUARE + 1.0 / short
    return full and _RULER[0] < aspect < _RULER[1]


def is_round(shape: Shape) -> bool:
    """Tell whether an object is round as far as pixels show, and seen whole."""
    return has_shape(shape, ReferenceKind.DISC)


def reference_among(shapes: Sequence[Shape], kind: ReferenceKind) -> Shape | None:
    """Return the object that is the reference, None when none is or it cannot be told from the body."""
    fitting = [shape for shape in shapes if shape.off_middle < _ZONE and has_shape(shape, kind)]
    if not fitting:
        return None
    best = min(fitting, key=lambda shape: shape.to_corner)
    if not any(shape.area > _COMPANY * best.area for shape in shapes if shape is not best):
        return None
    nearer = [
        shape
        for shape in shapes
        if shape is not best and shape.to_corner < best.to_corner and shape.area > _BESIDE * best.area
    ]
    # a slice may well be round, so that a disc must be nearest; few are square or straight bars
    doubtful = nearer if kind is ReferenceKind.DISC else [shape for shape in nearer if shape.cut_off]
    return None if doubtful else best


def _roundness(outline: NDArray[np.int32]) -> float:
    """Return the standard deviation of the radii by their mean."""
    points: FloatArray = outline[:, 0].astype(np.float64)
    moments = cv2.moments(outline)
    if moments["m00"] <= 0:
        return np.inf
    centre = np.array([moments["m10"], moments["m01"]]) / moments["m00"]
    radii = np.linalg.norm(points - centre, axis=1)
    return float(radii.std() / radii.mean())
