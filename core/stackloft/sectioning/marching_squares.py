"""Closed level lines of a sampled field (the plane case of Lorensen & Cline 1987).

::

    TL --T-- TR        A cell between four pixel centres. A crossing lies on each edge whose two
    |         |        ends differ; the line leaves one edge for another with the body on its
    L         R        left in (x, y) = (column, row), so that outlines come out with positive
    |         |        shoelace area and holes with negative.
    BL --B-- BR
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, IntArray

_T, _R, _B, _L = range(4)

_JOINED_5, _JOINED_10 = 16, 17
_LINES: tuple[tuple[tuple[int, int], ...], ...] = (
    (),
    ((_T, _L),),
    ((_R, _T),),
    ((_R, _L),),
    ((_B, _R),),
    ((_T, _L), (_B, _R)),
    ((_B, _T),),
    ((_B, _L),),
    ((_L, _B),),
    ((_T, _B),),
    ((_R, _T), (_L, _B)),
    ((_R, _B),),
    ((_L, _R),),
    ((_T, _R),),
    ((_L, _T),),
    (),
    ((_T, _R), (_B, _L)),
    ((_L, _T), (_R, _B)),
)
"""Lines of a cell, from edge to edge, by code TL + 2·TR + 4·BR + 8·BL; 16 and 17 are the two
saddles (5 and 10) whose centre belongs to the body."""

_FIRST = np.array([line[0] if line else (-1, -1) for line in _LINES])
_SECOND = np.array([line[1] if len(line) > 1 else (-1, -1) for line in _LINES])


@dataclass(frozen=True, slots=True, eq=False)
class Crossings:
    """Where one closed line crosses the grid, in order."""

    row: IntArray
    column: IntArray
    """(k) the pixel that each crossed edge starts from"""
    down: NDArray[np.bool_]
    """(k) True where the edge runs to the pixel below, False where to the one on the right"""


def closed_lines(inside: NDArray[np.bool_], field: FloatArray) -> list[Crossings]:
    """Return the closed lines around the True pixels of `inside`.

    Parameters
    ----------
    inside : ndarray of bool, (rows, columns)
        Must be False all along the border, so that every line closes.
    field : ndarray, (rows, columns)
        Positive inside; its sum over a saddle's four corners says whether the body is joined there.

    Examples
    --------
    >>> inside = np.zeros((4, 4), dtype=bool)
    >>> inside[1, 1] = inside[2, 2] = True
    >>> len(closed_lines(inside, np.where(inside, 1.0, -2.0)))
    2
    >>> len(closed_lines(inside, np.where(inside, 2.0, -1.0)))
    1
    """
    starts, ends = _directed_lines(inside, field)
    if not len(starts):
        return []
    columns = inside.shape[1]
    return [_crossings(starts[order], columns) for order in _cycles(starts, ends)]


def _directed_lines(inside: NDArray[np.bool_], field: FloatArray) -> tuple[IntArray, IntArray]:
    """Return the edge that each line leaves and the edge that it reaches, by edge number."""
    bits = inside.view(np.uint8)
    code = bits[:-1, :-1] + 2 * bits[:-1, 1:] + 4 * bits[1:, 1:] + 8 * bits[1:, :-1]
    row, column = np.nonzero((code != 0) & (code != 15))
    kind = code[row, column].astype(np.int64)
    saddle = np.flatnonzero((kind == 5) | (kind == 10))
    r, c = row[saddle], column[saddle]
    joined = saddle[field[r, c] + field[r, c + 1] + field[r + 1, c] + field[r + 1, c + 1] > 0]
    kind[joined] = np.where(kind[joined] == 5, _JOINED_5, _JOINED_10)
    two = np.flatnonzero(_SECOND[kind, 0] >= 0)
    sides = np.concatenate([_FIRST[kind], _SECOND[kind[two]]])
    row, column = np.concatenate([row, row[two]]), np.concatenate([column, column[two]])
    columns = inside.shape[1]
    return _edge_number(sides[:, 0], row, column, columns), _edge_number(sides[:, 1], row, column, columns)


def _edge_number(side: IntArray, row: IntArray, column: IntArray, columns: int) -> IntArray:
    """Return 2·pixel for the edge to the right of a pixel, 2·pixel + 1 for the edge below it."""
    pixel = (row + (side == _B)) * columns + column + (side == _R)
    number: IntArray = 2 * pixel + ((side == _L) | (side == _R))
    return number


def _cycles(starts: IntArray, ends: IntArray) -> list[IntArray]:
    """Return the lines in order around each closed loop."""
    order = np.argsort(starts)
    following: list[int] = order[np.searchsorted(starts[order], ends)].tolist()
    seen = bytearray(len(following))
    cycles: list[IntArray] = []
    for first in range(len(following)):
        if seen[first]:
            continue
        cycle, line = [], first
        while not seen[line]:
            seen[line] = 1
            cycle.append(line)
            line = following[line]
        cycles.append(np.array(cycle, dtype=np.int64))
    return cycles


def _crossings(edges: IntArray, columns: int) -> Crossings:
    row, column = np.divmod(edges // 2, columns)
    return Crossings(row, column, edges % 2 == 1)
