"""Into how many layers and columns a tube is swept: by the longest edge, or by the number of elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.disc_mesh import ring_pattern
from stackloft.geometry.tube_stations import stations

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

POLE_RINGS = 2
"""Fewest rings of elements in the row that ends in a pole."""
FEWEST = 8
"""Fewest columns."""
_CUTS = (0.1, 0.15, 0.2, 0.25, 1 / 3, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)
"""Parts that the longest patch along the loop is cut into, tried one after the other."""
_HALVINGS = 30


@dataclass(frozen=True, slots=True, eq=False)
class SweepPlan:
    """Stations in patches."""

    rows: FloatArray
    """(r,) along v, both ends among them"""
    columns: FloatArray
    """(c,) along u, 0 among them"""


def plan_by_size(
    lengths: tuple[FloatArray, FloatArray],
    sharp: tuple[BoolArray, BoolArray],
    poles: tuple[bool, bool],
    size: float,
) -> SweepPlan:
    """Return the stations that make no edge on the surface longer than `size`, diagonals included.

    Parameters
    ----------
    lengths : pair of arrays
        Of each row and of each column, mm (`tube_lengths`).
    sharp : pair of bool arrays
        (rows + 1,) and (columns,) lines where the surface turns sharply.
    poles : pair of bool
    size : float
        mm
    """
    side = size / np.sqrt(2.0)
    return SweepPlan(_rows(lengths[0], sharp[0], poles, side), _columns(lengths[1], sharp[1], side))


def plan_by_count(
    lengths: tuple[FloatArray, FloatArray],
    sharp: tuple[BoolArray, BoolArray],
    poles: tuple[bool, bool],
    growth: float,
    most: int,
) -> SweepPlan:
    """Return the stations of the best mesh with at most `most` elements, of the coarsest when there is none.

    The error of a surface of order 2 goes with the fourth power of its edges, so the best has the least sum
    of the fourth powers of the longest edge along the loop and across it.
    """
    best, least = None, np.inf
    for cut in _CUTS:
        columns = _columns(lengths[1], sharp[1], float(lengths[1].max()) / cut * (1.0 + 1e-9))
        triangles = len(ring_pattern(len(columns), growth)[1])
        rows = _most_rows(lengths[0], sharp[0], poles, most // triangles)
        plan = SweepPlan(rows, columns)
        if _elements(rows, poles, triangles) > most and best is not None:
            continue
        cost = (
            _longest(rows, lengths[0]) ** 4 + _longest(np.append(columns, len(lengths[1])), lengths[1]) ** 4
        )
        if cost < least:
            best, least = plan, cost
    assert best is not None
    return best


def _rows(lengths: FloatArray, sharp: BoolArray, poles: tuple[bool, bool], size: float) -> FloatArray:
    least = np.zeros(len(lengths))
    for end, pole in zip((0, -1), poles, strict=True):
        least[end] = max(least[end], POLE_RINGS if pole else 0)
    return stations(lengths, sharp, size, least)


def _columns(lengths: FloatArray, sharp: BoolArray, size: float) -> FloatArray:
    """Return the columns' stations, begun at a sharp line where there is one."""
    start = int(np.flatnonzero(sharp)[0]) if sharp.any() else 0
    turned = np.roll(sharp, -start)
    size = min(size, float(lengths.sum()) / FEWEST)
    found = stations(np.roll(lengths, -start), np.append(turned, True), size)[:-1]
    return np.sort((found + start) % len(lengths))


def _elements(rows: FloatArray, poles: tuple[bool, bool], triangles: int) -> int:
    """Return how many tetrahedra: three to a prism, one to a triangle under a pole."""
    return (3 * (len(rows) - 1) - 2 * sum(poles)) * triangles


def _most_rows(lengths: FloatArray, sharp: BoolArray, poles: tuple[bool, bool], layers: float) -> FloatArray:
    """Return the finest rows with at most `layers` tetrahedra over a triangle; the coarsest at worst."""
    long, short = 2.0 * float(lengths.sum()), 0.0
    for _ in range(_HALVINGS):
        size = 0.5 * (long + short)
        few = _elements(_rows(lengths, sharp, poles, size), poles, 1) <= layers
        long, short = (size, short) if few else (long, size)
    return _rows(lengths, sharp, poles, long)


def _longest(found: FloatArray, lengths: FloatArray) -> float:
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    return float(np.diff(np.interp(found, np.arange(len(along)), along)).max())
