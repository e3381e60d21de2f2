r"""Pieces of sections, followed inwards, and carried on beyond the section in which they end.

::

     row i+1    .   .   .   .      nothing here: the piece ends between row i and row i+1
     row i       ( piece )
     row i−1    (  piece  )        the parabola through its rows is what row i+1 would hold,
     row i−2   (   piece   )       were it to go on below zero

A hole is a piece of the field's negative that nothing but body surrounds.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from stackloft.model.arrays import FloatArray

BoolArray = NDArray[np.bool_]

_STEADY = 0.5
"""A piece whose field keeps more than this part of its height does not close: it ends half-way, flat."""
_WIDE = 1.5
"""How far around a piece it is carried on, over its thickness."""


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """Rows as seen along z from the outermost one in."""

    field: FloatArray
    """(k, rows, columns) mm²"""
    distance: FloatArray
    """(k, rows, columns) mm"""
    z: FloatArray
    """(k,) mm"""
    step: float
    """mm"""

    def flipped(self) -> Sight:
        """Return the rows in the other order."""
        return Sight(self.field[::-1], self.distance[::-1], self.z[::-1], self.step)

    def inside_out(self) -> Sight:
        """Return body and background exchanged."""
        return Sight(-self.field, -self.distance, self.z, self.step)


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """One connected part of a row."""

    row: int
    mask: BoolArray
    """(rows, columns)"""
    around: BoolArray
    """(rows, columns): the piece and what lies near it and nearer to it than to others."""
    ring: bool
    """True when it has holes."""


def pieces(sight: Sight, row: int) -> Iterator[Piece]:
    """Yield the pieces of a row; what touches the grid's border is background."""
    labels, count = ndimage.label(sight.field[row] > 0.0)
    edge = np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]])
    if not count:
        return
    near = ndimage.distance_transform_edt(labels == 0, return_distances=False, return_indices=True)
    owner = labels[tuple(near)]
    for k in set(range(1, count + 1)) - set(edge.tolist()):
        mask = labels == k
        thick = max(float(sight.distance[row][mask].max()), 2.0 * sight.step)
        around = (owner == k) & (sight.distance[row] > -_WIDE * thick)
        yield Piece(row, mask, around, _ringed(mask))


def _ringed(mask: BoolArray) -> bool:
    return bool((ndimage.binary_fill_holes(mask) & ~mask).any())


def same_piece(sight: Sight, piece: Piece, direction: int) -> list[BoolArray]:
    """Return the piece's masks on its own row and up to two rows further, while it stays one and alike."""
    masks = [piece.mask]
    for row in (piece.row + direction, piece.row + 2 * direction):
        if not 0 <= row < len(sight.z):
            break
        labels, _ = ndimage.label(sight.field[row] > 0.0)
        below = _labels_in(labels, masks[-1])
        if len(below) != 1:
            break
        mask = labels == below[0]
        before, _ = ndimage.label(sight.field[row - direction] > 0.0)
        if len(_labels_in(before, mask)) != 1 or _ringed(mask) != piece.ring:
            break
        masks.append(mask)
    return masks


def _labels_in(labels: NDArray[Any], mask: BoolArray) -> list[int]:
    return [int(k) for k in np.unique(labels[mask]) if k > 0]


def continued(sight: Sight, rows: list[int], at: float) -> FloatArray:
    """Return the polynomial through some rows of the field at position `at`, (rows, columns) mm²."""
    z = sight.z[rows]
    weights = [np.prod([(at - b) / (a - b) for b in z if b != a]) for a in z]
    return np.asarray(np.tensordot(weights, sight.field[rows], axes=1))


def reach(sight: Sight, piece: Piece, rows: list[int], far: float) -> float | None:
    """Return how far beyond its row (rows[0]) a piece is gone, mm, or None when not within `far`."""
    if len(rows) < 2:
        return None
    outward = float(np.sign(sight.z[rows[0]] - sight.z[rows[1]]))

    def top(t: float) -> float:
        return float(continued(sight, rows, float(sight.z[rows[0]]) + outward * t)[piece.around].max())

    gone = next((t for t in np.linspace(0.0, far, 33)[1:] if top(t) <= 0.0), None)
    if gone is None:
        return None
    low, high = gone - far / 32, float(gone)
    for _ in range(12):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if top(middle) <= 0.0 else (middle, high)
    return high


def carried_on(sight: Sight) -> FloatArray:
    """Return the field with every piece, of body or of hole, carried on for two rows beyond where it ends."""
    found = sight.field
    for flip in (False, True):
        for turn in (False, True):
            seen = sight.inside_out() if turn else sight
            held = _held_beyond(seen.flipped() if flip else seen)
            held = held[::-1] if flip else held
            held = -held if turn else held
            new, old = held != sight.field, found != sight.field
            nearer = np.abs(held) < np.abs(found)
            found = np.where(new & (~old | nearer), held, found)
    return found


def _held_beyond(sight: Sight) -> FloatArray:
    """Return the field with pieces that end towards the last row carried on."""
    found = sight.field.copy()
    for row in range(len(sight.z) - 1):
        for piece in pieces(sight, row):
            if (sight.field[row + 1][piece.mask] > 0.0).any():
                continue
            beyond = _beyond(sight, piece)
            for k, values in enumerate(beyond, start=row + 1):
                found[k] = np.where(piece.around, np.maximum(found[k], values), found[k])
    return found


def _beyond(sight: Sight, piece: Piece) -> list[FloatArray]:
    """Return what the one or two rows beyond a piece's end would hold, negative."""
    row, tiny = piece.row, -1e-3 * sight.step**2
    rows = [row - k for k in range(len(same_piece(sight, piece, -1)))]
    beyond = range(row + 1, min(row + 3, len(sight.z)))
    own = sight.field[row]
    ends = reach(sight, piece, rows, abs(float(sight.z[row + 1] - sight.z[row])))
    following = continued(sight, rows, float(sight.z[row + 1]))
    top = float(following[piece.around].max())
    if ends is None and (len(rows) < 2 or top > _STEADY * float(own[piece.around].max())):
        return [-((k - row) ** 2) * np.abs(own) for k in beyond]
    shift = 0.0 if ends is not None else top
    values = [np.minimum(continued(sight, rows, float(sight.z[k])) - shift, tiny) for k in beyond]
    return [values[0], *(np.minimum(value, values[0]) for value in values[1:])]
