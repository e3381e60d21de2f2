"""One look at a slice: its pieces, their borders, and the background that they close in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.solid_piece import SolidPiece, solid_pieces
from stackloft.model.arrays import BoolArray, IntArray
from stackloft.model.segmentation import SectionField, Segmentation, above
from stackloft.model.slice_stack import Picture
from stackloft.sectioning.slice_pieces import Corner, Pieces, body_pieces, pieces_of
from stackloft.sectioning.voids import CRACKS, closed_background

FRAME = CRACKS.frame
"""Pixels around the bodies within which background is looked through for what is closed in."""


@dataclass(frozen=True, slots=True, eq=False)
class SliceLook:
    """What a slice shows, before it is known what belongs together."""

    pieces: Pieces
    sizes: IntArray
    labels: IntArray
    corner: Corner
    """Of the pieces' bounding box."""
    outline: NDArray[np.int32] | None
    """Of a body that is one piece without a hole."""
    body: BoolArray
    """Where any body is, on the bounding box with a frame."""
    closed: Pieces | None
    framed: Corner
    """Of `body` and `closed`."""


def look_at_all(
    segmentation: Segmentation, slices: Sequence[tuple[Picture, SectionField]]
) -> list[SliceLook]:
    """Return the slices' pieces, their pixels and labels, and the background that they close in."""
    quick = [not segmentation.labels and _shows_all(section, picture) for picture, section in slices]
    alike = [(own.values, own.level) for (_, own), plain in zip(slices, quick, strict=True) if plain]
    solids = iter(solid_pieces(alike, CRACKS))
    found = [next(solids) if plain else None for plain in quick]
    return [
        _closer_look(segmentation, picture, section) if solid is None else _look_at_solid(section, solid)
        for solid, (picture, section) in zip(found, slices, strict=True)
    ]


def _shows_all(section: SectionField, picture: Picture) -> bool:
    """Return whether a field is of a whole slice, with one level."""
    return section.local_levels is None and section.values.shape == picture.shape[:2]


def _closer_look(segmentation: Segmentation, picture: Picture, section: SectionField) -> SliceLook:
    if segmentation.labels:
        (pieces, sizes, labels, corner), outline = _labelled_pieces(picture), None
        shown = pieces > 0
    else:
        shown = section.above()
        found = body_pieces(shown)
        pieces, sizes = found.pieces, found.sizes
        corner = (section.offset[0] + found.corner[0], section.offset[1] + found.corner[1])
        outline = None if found.outline is None else found.outline + np.array(section.offset[::-1], np.int32)
        labels = np.zeros(len(sizes), dtype=np.int64)
    rows, columns = framed_window(pieces.shape, corner, FRAME, picture.shape)
    if shown.shape == picture.shape[:2]:
        body = shown[rows, columns]
    else:
        body = np.zeros((rows.stop - rows.start, columns.stop - columns.start), dtype=np.bool_)
        top, left = corner[0] - rows.start, corner[1] - columns.start
        body[top : top + pieces.shape[0], left : left + pieces.shape[1]] = pieces > 0
    looked = len(sizes) and not segmentation.labels
    apart = body.shape == tuple(side + 2 * FRAME for side in pieces.shape)
    closed = closed_background(body, solid=outline is not None, apart=apart) if looked else None
    return SliceLook(pieces, sizes, labels, corner, outline, body, closed, (rows.start, columns.start))


def _look_at_solid(section: SectionField, found: SolidPiece) -> SliceLook:
    """Return the look of a whole slice whose body is known to be one piece without a hole."""
    rows, columns = framed_window(found.shape, found.corner, FRAME, section.values.shape)
    body = above(section.values[rows, columns], section.level)
    framed = (rows.start, columns.start)
    top, left = (found.corner[k] - framed[k] for k in (0, 1))
    pieces = body[top : top + found.shape[0], left : left + found.shape[1]].view(np.uint8)
    apart = body.shape == tuple(side + 2 * FRAME for side in pieces.shape)
    closed = None if found.open else closed_background(body, solid=True, apart=apart)
    sizes, labels = np.array([found.pixels]), np.zeros(1, dtype=np.int64)
    return SliceLook(pieces, sizes, labels, found.corner, found.outline, body, closed, framed)


def framed_window(
    shape: tuple[int, ...], corner: Corner, frame: int, whole: tuple[int, ...]
) -> tuple[slice, slice]:
    """Return the rows and columns of a box and a frame around it, within the picture."""
    low = [max(0, corner[k] - frame) for k in (0, 1)]
    high = [min(whole[k], corner[k] + shape[k] + frame) for k in (0, 1)]
    return slice(low[0], high[0]), slice(low[1], high[1])


def _labelled_pieces(picture: Picture) -> tuple[Pieces, IntArray, IntArray, Corner]:
    """Return the pieces of all labels, numbered one after the other, their pixels, labels and corner."""
    left, top, width, height = cv2.boundingRect((picture > 0).view(np.uint8))
    part, corner = picture[top : top + height, left : left + width], (top, left)
    whole, counts, labels = np.zeros(part.shape, np.int32), [_NO_INTS], [_NO_INTS]
    done = 0
    for label in np.unique(part[part > 0]):
        pieces, sizes = pieces_of(part == label)
        np.copyto(whole, pieces + done, where=pieces > 0)
        done += len(sizes)
        counts.append(sizes)
        labels.append(np.full(len(sizes), int(label)))
    return whole, np.concatenate(counts), np.concatenate(labels), corner


_NO_INTS: IntArray = np.zeros(0, dtype=np.int64)
