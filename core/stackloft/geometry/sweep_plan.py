"""Into how many layers and columns a tube is swept: by the longest edge, or by the number of elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.disc_mesh import ring_pattern
from stackloft.geometry.ring_mesh import band_pattern
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
    columns: tuple[FloatArray, ...]
    """(c,) of each tube along u, 0 among them"""


@dataclass(frozen=True, slots=True, eq=False)
class SweepLines:
    """The lines of one tube of patches, or of two with a wall between them."""

    rows: FloatArray
    """(r,) length of each row, mm (`tube_lengths`)"""
    columns: tuple[FloatArray, ...]
    """(c,) length of each column of each tube, mm"""
    sharp_rows: BoolArray
    """(r + 1,) where a surface turns sharply"""
    sharp_columns: tuple[BoolArray, ...]
    """(c,) likewise"""
    poles: tuple[bool, bool]
    width: float = 0.0
    """mm from tube to tube, when there are two"""

    def triangles(self, columns: tuple[FloatArray, ...], growth: float) -> int:
        """Return how many triangles a layer has."""
        if len(columns) == 1:
            return len(ring_pattern(len(columns[0]), growth)[1])
        counts = len(columns[0]), len(columns[1])
        lengths = float(self.columns[0].sum()), float(self.columns[1].sum())
        return len(band_pattern(counts, lengths, self.width, growth).triangles)

    def columns_at(self, size: float) -> tuple[FloatArray, ...]:
        """Return the stations along u that lie no further apart than `size`, mm."""
        return tuple(_columns(*own, size) for own in zip(self.columns, self.sharp_columns, strict=True))


def plan_by_size(lines: SweepLines, size: float) -> SweepPlan:
    """Return the stations that make no edge on the surface longer than `size`, mm, diagonals included."""
    side = size / np.sqrt(2.0)
    return SweepPlan(_rows(lines, side), lines.columns_at(side))


def plan_by_count(lines: SweepLines, growth: float, most: int) -> SweepPlan:
    """Return the stations of the best mesh with at most `most` elements, of the coarsest when there is none.

    The error of a surface of order 2 goes with the fourth power of its edges, so the best has the least sum
    of the fourth powers of the longest edge along the loop and across it.
    """
    best, least = None, np.inf
    longest = max(float(own.max()) for own in lines.columns)
    for cut in _CUTS:
        columns = lines.columns_at(longest / cut * (1.0 + 1e-9))
        triangles = lines.triangles(columns, growth)
        rows = _most_rows(lines, most // triangles)
        if _elements(rows, lines.poles, triangles) > most and best is not None:
            continue
        around = max(
            _longest(np.append(own, len(lengths)), lengths)
            for own, lengths in zip(columns, lines.columns, strict=True)
        )
        cost = _longest(rows, lines.rows) ** 4 + around**4
        if cost < least:
            best, least = SweepPlan(rows, columns), cost
    assert best is not None
    return best


def _rows(lines: SweepLines, size: float) -> FloatArray:
    least = np.zeros(len(lines.rows))
    for end, pole in zip((0, -1), lines.poles, strict=True):
        least[end] = max(least[end], POLE_RINGS if pole else 0)
    return stations(lines.rows, lines.sharp_rows, size, least)


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


def _most_rows(lines: SweepLines, layers: float) -> FloatArray:
    """Return the finest rows with at most `layers` tetrahedra over a triangle; the coarsest at worst."""
    long, short = 2.0 * float(lines.rows.sum()), 0.0
    for _ in range(_HALVINGS):
        size = 0.5 * (long + short)
        few = _elements(_rows(lines, size), lines.poles, 1) <= layers
        long, short = (size, short) if few else (long, size)
    return _rows(lines, long)


def _longest(found: FloatArray, lengths: FloatArray) -> float:
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    return float(np.diff(np.interp(found, np.arange(len(along)), along)).max())
