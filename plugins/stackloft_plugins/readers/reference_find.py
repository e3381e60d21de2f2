"""A reference object found in a picture, measured, and hidden from whoever looks for the body."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.reference import ReferenceKind
from stackloft_plugins.readers.reference_shapes import (
    LEVELS,
    Shape,
    contrast_with_plate,
    greatest,
    reference_among,
    shapes_at,
)
from stackloft_plugins.readers.reference_sighting import Found, Missing, PixelSize
from stackloft_plugins.readers.reference_size import bar_size, disc_size

_SMALL = 900  # pixels on the longer side of the copy in which objects are looked for
_MARGIN = 0.10  # of its size, hidden around it: its shadow
_MISSHAPEN = 0.012  # of its size
_OBLIQUE = 0.06
_ENOUGH = 5000  # pixels for a median colour
_SAME_PLACE = 0.06  # of the picture's sides


def find_reference(picture: NDArray[Any], kind: ReferenceKind) -> Found | Missing:
    """Return the reference object of a picture, (rows, columns) or (rows, columns, 3).

    Examples
    --------
    >>> scene = np.full((200, 300), 240, dtype=np.uint8)
    >>> scene[60:160, 120:260] = 90
    >>> scene[20:60, 20:60] = 120
    >>> round(find_reference(scene, ReferenceKind.SQUARE).size.size, 2)
    40.0
    """
    rows, columns = picture.shape[:2]
    small, step = reduced(picture, _SMALL)
    contrast = contrast_with_plate(small)
    most = greatest(contrast)
    sightings: list[_Sighting] = []
    cut_off = False
    for part in LEVELS:
        shapes = shapes_at(contrast, part * most)
        cut_off |= _cut_in_a_corner(shapes)
        shape = reference_among(shapes, kind)
        if shape is None or any(_same(shape, seen.shape) for seen in sightings):
            continue
        measured = _measured(picture, shape, kind, step)
        if measured is not None:
            others = [other for other in shapes if other is not shape]
            sightings.append(_Sighting(measured, shape, others))
    if sightings:
        seen = _outermost(sightings)
        return object_found(seen.size, seen.shape, seen.others, step, (rows, columns))
    if cut_off:
        return Missing("an object in a corner is cut off by the picture's border", cut_off=True)
    return Missing(f"no {kind.value} in any corner that stands apart from the body")


def hide(picture: NDArray[Any], found: Found) -> None:
    """Put plate where the reference object lies in the picture: the median colour around it."""
    row, column = found.corner
    height, width = found.hidden.shape
    part = picture[row : row + height, column : column + width]
    hidden = found.hidden.view(np.uint8)
    ring = np.flatnonzero((cv2.dilate(hidden, np.ones((9, 9), np.uint8)) > hidden).view(np.bool_))
    some = np.unravel_index(ring[:: 1 + len(ring) // _ENOUGH], found.hidden.shape)
    plate = np.median(part[some], axis=0).astype(picture.dtype)
    np.copyto(part, plate, where=found.hidden if picture.ndim == 2 else found.hidden[..., None])


@dataclass(frozen=True, slots=True, eq=False)
class _Sighting:
    """What was measured at one threshold."""

    size: PixelSize
    shape: Shape
    others: list[Shape]


def _same(shape: Shape, seen: Shape) -> bool:
    """Tell whether two thresholds show the same outline, to a pixel of the small copy."""
    moved = np.hypot(shape.centre[0] - seen.centre[0], shape.centre[1] - seen.centre[1])
    return bool(moved < 1.0) and abs(shape.area - seen.area) < 0.5 * (len(shape.outline) + 4)


def _outermost(sightings: list[_Sighting]) -> _Sighting:
    """Return the largest of what was seen nearest to a corner: a coin's rim, not the ring stamped within."""
    nearest = min(seen.shape.to_corner for seen in sightings)
    same = [seen for seen in sightings if seen.shape.to_corner <= nearest + _SAME_PLACE]
    return max(same, key=lambda seen: seen.size.size)


def reduced(picture: NDArray[Any], longest: int) -> tuple[NDArray[Any], float]:
    """Return a copy of the picture whose longer side has about so many pixels, and by how much it is smaller.

    From twice that size on by a whole number, a twentieth of the time: the copy is up to half as large again.
    """
    rows, columns = picture.shape[:2]
    step = max(1.0, max(rows, columns) / longest)
    if step == 1.0:
        return picture, step
    size = (round(columns / step), round(rows / step))
    if step >= 2.0:
        whole = int(step)
        size, step = (columns // whole, rows // whole), float(whole)
        picture = picture[: whole * size[1], : whole * size[0]]
    return cv2.resize(resizable(picture), size, interpolation=cv2.INTER_AREA), step


def resizable(picture: NDArray[Any]) -> NDArray[Any]:
    """Return the picture in a dtype that OpenCV scales down."""
    return picture if picture.dtype in {np.dtype("uint8"), np.dtype("uint16")} else picture.astype(np.float32)


def _cut_in_a_corner(shapes: list[Shape]) -> bool:
    return any(shape.cut_off and shape.to_corner < 0.4 for shape in shapes)


def _measured(picture: NDArray[Any], shape: Shape, kind: ReferenceKind, step: float) -> PixelSize | None:
    """Return the size on the whole picture's own pixels; None for what has not the shape when seen so."""
    grey, (left, top) = grey_window(picture, shape, step)
    (x, y), sides, angle = shape.box
    middle = ((x + 0.5) * step - 0.5 - left, (y + 0.5) * step - 0.5 - top)
    lengths = (sides[0] * step, sides[1] * step)
    if kind is ReferenceKind.DISC:
        size = disc_size(grey, middle, 0.25 * sum(lengths))
    else:
        size = bar_size(grey, (middle, lengths, angle), kind)
    if size is None or size.misfit > _MISSHAPEN + 0.3 / size.size or size.oblique > _OBLIQUE:
        return None
    return size


def grey_window(
    picture: NDArray[Any], shape: Shape, step: float
) -> tuple[NDArray[np.float32], tuple[int, int]]:
    """Return the object's surroundings as one channel, the one in which it stands out best."""
    x, y, width, height = (float(value) for value in cv2.boundingRect(shape.outline))
    room = 0.1 * max(width, height) + 8 / step + 2
    rows, columns = picture.shape[:2]
    left, top = max(0, int((x - room) * step)), max(0, int((y - room) * step))
    right = min(columns, int((x + width + room) * step) + 1)
    bottom = min(rows, int((y + height + room) * step) + 1)
    part = picture[top:bottom, left:right].astype(np.float32)
    if part.ndim == 2:
        return part, (left, top)
    inside = np.zeros(part.shape[:2], np.uint8)
    outline = (shape.outline.astype(np.float64) + 0.5) * step - 0.5 - [left, top]
    cv2.drawContours(inside, [np.round(outline).astype(np.int32)], -1, 1, cv2.FILLED)
    pixels = part.reshape(-1, part.shape[2])
    own, beside = (
        np.median(pixels[where[:: 1 + len(where) // _ENOUGH]], axis=0)
        for where in (np.flatnonzero(inside), np.flatnonzero(inside == 0))
    )
    off = own - beside
    grey: NDArray[np.float32] = np.asarray(cv2.transform(part, (off / np.abs(off).sum())[None]), np.float32)
    return grey, (left, top)


def object_found(
    size: PixelSize, shape: Shape, others: list[Shape], step: float, whole: tuple[int, int]
) -> Found:
    """Return the object with the window that hides it, which leaves every other object alone."""
    x, y, width, height = (float(value) for value in cv2.boundingRect(shape.outline))
    margin = _MARGIN * size.size + 3 + step
    left, top = max(0, int(x * step - 2 * margin)), max(0, int(y * step - 2 * margin))
    right = min(whole[1], int((x + width) * step + 2 * margin) + 1)
    bottom = min(whole[0], int((y + height) * step + 2 * margin) + 1)
    window = (bottom - top, right - left)
    own = _drawn(shape, step, (left, top), window, margin)
    for other in others:
        own &= ~_drawn(other, step, (left, top), window, 2 + step)
    centre = ((shape.centre[0] + 0.5) * step - 0.5, (shape.centre[1] + 0.5) * step - 0.5)
    return Found(size, centre, (top, left), own)


def _drawn(
    shape: Shape, step: float, corner: tuple[int, int], window: tuple[int, int], margin: float
) -> NDArray[np.bool_]:
    """Return where a window of the picture lies within `margin` of the shape, as finely as the copy shows."""
    rows, columns = (math.ceil(side / step) for side in window)
    mask = np.ones((rows, columns), np.uint8)
    outline = np.round(shape.outline - (np.array(corner) / step)).astype(np.int32)
    cv2.drawContours(mask, [outline], -1, 0, cv2.FILLED)
    # by distance: dilating by a disc as wide as a coin's margin takes a second
    near = cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) <= margin / step
    row, column = (np.minimum((np.arange(side) / step).astype(int), most - 1)
                   for side, most in zip(window, (rows, columns), strict=True))  # fmt: skip
    return np.asarray(near[row][:, column])
