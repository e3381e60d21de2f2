"""Pieces of slices told apart where bodies that touch were cut (`touching_bodies`)."""

from __future__ import annotations

import numpy as np

from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.model.slice_stack import SliceStack
from stackloft.sectioning.linked_pieces import LinkedPieces
from stackloft.sectioning.slice_pieces import Pieces, pieces_of
from stackloft.sectioning.touching_bodies import Labels, basins, on_window, stride_for
from stackloft.sectioning.voids import VoidFinder

_Box = tuple[int, int, int, int]


def cut_apart(links: LinkedPieces, voids: VoidFinder, stack: SliceStack, neck: float) -> LinkedPieces:
    """Return the slices' pieces anew, those of different bodies apart, each with its body's number as label.

    Parameters
    ----------
    links : LinkedPieces
        Of whole slices, sizes in mm³.
    voids : VoidFinder
        Of the same slices; a void is part of the body that it makes no neck in.
    stack : SliceStack
    neck : float
        As for `basins`.
    """
    box = _box(links)
    stride = stride_for((len(links), box[2] - box[0], box[3] - box[1]))
    solid = np.stack([_solid(links, voids, k, box, stride) for k in range(len(links))])
    row, column = (stride * float(side) for side in stack.pixel_spacing.mean(axis=0))
    owner = basins(solid, (float(np.diff(stack.positions).mean()), row, column), neck)
    voxel = stack.pixel_spacing.prod(axis=1) * np.gradient(stack.positions)
    cut = LinkedPieces()
    for k in range(len(links)):
        pieces, corner = links.pieces(k)
        here = _widened(owner[k], stride)[
            corner[0] - box[0] : corner[0] - box[0] + pieces.shape[0],
            corner[1] - box[1] : corner[1] - box[1] + pieces.shape[1],
        ]
        numbered, sizes, labels = _told_apart(pieces > 0, here)
        cut.add(numbered, sizes * voxel[k], labels, corner)
    return cut


def _box(links: LinkedPieces) -> _Box:
    """Return top, left, bottom, right of all slices' pieces."""
    crops = [links.shape(k) for k in range(len(links))]
    used = [(corner, shape) for corner, shape in crops if min(shape) > 0]
    low = np.min([corner for corner, _ in used], axis=0)
    high = np.max([(c[0] + s[0], c[1] + s[1]) for c, s in used], axis=0)
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


def _solid(links: LinkedPieces, voids: VoidFinder, k: int, box: _Box, stride: int) -> BoolArray:
    """Return a slice's bodies without their voids, every `stride`-th pixel of the box."""
    pieces, corner = links.pieces(k)
    body = np.asarray(on_window(pieces, corner, box, stride) > 0)
    if voids.has_closed(k):
        closed, (row, column) = voids.closed(k)
        top, left = max(box[0] - row, 0), max(box[1] - column, 0)
        part = closed[top : box[2] - row, left : box[3] - column]
        body = body | (on_window(part, (row + top, column + left), box, stride) > 0)
    return body


def _widened(owner: Labels, stride: int) -> Labels:
    """Return a coarse slice of numbers on all pixels; those at the rim go to a body beside them."""
    if stride == 1:
        return owner
    from scipy.ndimage import grey_dilation  # noqa: PLC0415 - for a rare request

    rim = np.where(owner > 0, owner, grey_dilation(owner, size=(3, 3)))
    return np.asarray(rim.repeat(stride, axis=0).repeat(stride, axis=1), dtype=np.int32)


def _told_apart(body: BoolArray, owner: Labels) -> tuple[Pieces, FloatArray, IntArray]:
    """Return the pieces of a slice's body, those of one owner numbered after the other's."""
    numbered = np.zeros(body.shape, dtype=np.int32)
    counts, labels, done = [np.zeros(0)], [np.zeros(0, dtype=np.int64)], 0
    for one in np.unique(owner[body & (owner > 0)]):
        pieces, sizes = pieces_of(body & (owner == one))
        np.copyto(numbered, pieces + done, where=pieces > 0)
        done += len(sizes)
        counts.append(sizes.astype(np.float64))
        labels.append(np.full(len(sizes), int(one)))
    return numbered, np.concatenate(counts), np.concatenate(labels)
