"""Where a stack of any topology ends: piece by piece, discs over poles, rings and long pieces over ridges."""

from __future__ import annotations

import math

import numpy as np
from scipy import ndimage

from stackloft.geometry.end_model import distance_to_end
from stackloft.model.arrays import FloatArray
from stackloft.model.ends import EndKind
from stackloft.sectioning.ends import PlannedEnd
from stackloft_plugins.reconstructors.pieces import (
    BoolArray,
    Piece,
    Sight,
    continued,
    pieces,
    reach,
    same_piece,
)

LONG = 6.0
"""A piece whose area is more than this many times that of its largest disc closes over a ridge."""


def closing_areas(sight: Sight, areas: FloatArray) -> FloatArray:
    """Return areas from whose outermost three the end can be guessed; the first row is the outermost.

    Those of the piece that reaches furthest. Over a ridge it is the squared half-width that goes to
    zero linearly, as the area does over a pole; where a piece's width is no guide (a rim, whose section one
    pitch further in is no ring any more) the areas are constant, and half a pitch will be assumed.

    Parameters
    ----------
    sight : Sight
    areas : (k,) array
        Of whole sections, mm².
    """
    found = list(pieces(sight, 0))
    if len(found) == 1 and not _over_a_ridge(sight, found[0]) and len(same_piece(sight, found[0], 1)) > 2:
        return areas
    best = max((_closing(sight, piece) for piece in found), key=lambda values: values[0], default=[])
    count = min(len(best), len(areas))
    return np.concatenate([best[:count], areas[count:]])


def _over_a_ridge(sight: Sight, piece: Piece) -> bool:
    return piece.ring or _area(sight, 0, piece.mask) > LONG * math.pi * _half_width(sight, 0, piece.mask) ** 2


def _area(sight: Sight, row: int, mask: BoolArray) -> float:
    """Return a piece's area, mm², by the part of each cell that the distance lets it cover."""
    near = ndimage.binary_dilation(mask, iterations=2)
    return float(np.clip(0.5 + sight.distance[row] / sight.step, 0.0, 1.0)[near].sum() * sight.step**2)


def _half_width(sight: Sight, row: int, mask: BoolArray) -> float:
    return float(sight.distance[row][mask].max())


def _closing(sight: Sight, piece: Piece) -> list[float]:
    masks = same_piece(sight, piece, 1)
    depth = np.abs(sight.z - sight.z[0])
    if not _over_a_ridge(sight, piece):
        values = [_area(sight, row, mask) for row, mask in enumerate(masks)]
    else:
        values = [math.pi * _half_width(sight, row, mask) ** 2 for row, mask in enumerate(masks)]
        root = distance_to_end(np.array(values), depth[: len(values)])
        if root is None or root > depth[1]:
            values = values[:1]
    if len(values) == 1:
        return values * 3
    if len(values) == 2 and len(depth) > 2:
        rise = (values[1] - values[0]) / depth[1]
        return [*values, values[0] + rise * float(depth[2])]
    return values


def end_row(sight: Sight, end: PlannedEnd) -> FloatArray:
    """Return the field at the end, (rows, columns): zero on poles and ridges, or a flat end's section."""
    pitch = abs(float(sight.z[0] - sight.z[1]))
    at = float(sight.z[0]) + float(np.sign(sight.z[0] - sight.z[1])) * end.length
    if end.kind is EndKind.FLAT:
        return continued(sight, [0, 1], at) if end.length <= pitch else sight.field[0]
    row: FloatArray = -np.abs(sight.field[0])
    reaches, tops, values = [], [], []
    found = list(pieces(sight, 0))
    for piece in found:
        rows = list(range(len(same_piece(sight, piece, 1))))
        gone = reach(sight, piece, rows, 3.0 * pitch) if len(rows) > 1 else 0.5 * pitch
        reaches.append(math.inf if gone is None else gone)
        values.append(continued(sight, rows, at))
        tops.append(float(values[-1][piece.around].max()))
    for k, piece in enumerate(found):
        shift = max(tops[k], 0.0) if reaches[k] < max(reaches) else tops[k]
        row[piece.around] = np.minimum(values[k] - shift, 0.0)[piece.around]
    return row
