"""The 4-connected pieces of one slice's body; a single one, the usual case, is known by its borders alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import BoolArray, IntArray

Pieces = NDArray[Any]
"""(rows, columns), whole numbers: the piece that a pixel belongs to, from 1; 0: none"""
Corner = tuple[int, int]
"""(row, column) of a crop's first pixel in the slice."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyPieces:
    """The 4-connected pieces of a slice's body, on their bounding box."""

    pieces: Pieces
    sizes: IntArray
    """Pixels of each."""
    corner: Corner
    """Of the bounding box."""
    outline: NDArray[np.int32] | None = None
    """As a `SectionField` has it, of a single piece without a hole."""


def body_pieces(body: BoolArray) -> BodyPieces:
    """Return the pieces of a slice's body; a single one, the usual case, is known by its borders alone.

    Examples
    --------
    >>> body = np.zeros((6, 9), dtype=bool)
    >>> body[2:4, 3:8] = True
    >>> found = body_pieces(body)
    >>> found.pieces.shape, found.sizes.tolist(), found.corner, len(found.outline)
    ((2, 5), [10], (2, 3), 10)
    """
    bits = np.ascontiguousarray(body).view(np.uint8)
    chains = single_piece(bits)
    left, top, width, height = cv2.boundingRect(chains[0] if chains else bits)
    crop = bits[top : top + height, left : left + width]
    if not crop.size:
        return BodyPieces(crop, np.zeros(0, dtype=np.int64), (top, left))
    if not chains:
        return BodyPieces(*pieces_of(crop.view(np.bool_)), (top, left))
    outline = chains[0] if len(chains) == 1 else None
    return BodyPieces(np.ascontiguousarray(crop), np.array([cv2.countNonZero(crop)]), (top, left), outline)


def single_piece(bits: NDArray[np.uint8]) -> list[NDArray[np.int32]]:
    """Return the borders of pixels that certainly form one 4-connected piece; nothing of others.

    Returns
    -------
    list of (k, 2) arrays
        Column, row of the outline's pixels, then of each hole's. A pinched piece may be missed.
    """
    outlines, tree = cv2.findContours(bits, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    if tree is None or np.count_nonzero(tree[0, :, 3] < 0) != 1:
        return []
    order = np.argsort(tree[0, :, 3] >= 0, kind="stable") if len(outlines) > 1 else (0,)
    chains = [np.asarray(outlines[k][:, 0], np.int32) for k in order]
    return [] if any(pinched(bits, chain) for chain in chains) else chains


def pinched(bits: NDArray[np.uint8], chain: NDArray[Any]) -> bool:
    """Return whether a chain of border pixels steps between two that touch by their corners alone."""
    x, y = np.ascontiguousarray(chain.T)
    to_x, to_y = np.concatenate([x[1:], x[:1]]), np.concatenate([y[1:], y[:1]])
    slanting = np.flatnonzero((x != to_x) & (y != to_y))
    x, y, to_x, to_y = x[slanting], y[slanting], to_x[slanting], to_y[slanting]
    return not bool((bits[y, to_x] | bits[to_y, x]).all())


def pieces_of(mask: BoolArray, connectivity: int = 4) -> tuple[Pieces, IntArray]:
    """Return the connected pieces of a slice's mask and their sizes in pixels."""
    count, pieces = cv2.connectedComponents(mask.astype(np.uint8), connectivity=connectivity)
    return np.asarray(pieces, np.int32), np.bincount(pieces.ravel(), minlength=count)[1:].astype(np.int64)
