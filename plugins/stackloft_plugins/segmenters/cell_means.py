r"""Values known at some pixels, averaged in a Gaussian window about each pixel, on a grid of cells.

::

    . . x .|. . . .|      x: a pixel with a value. A window much wider than a cell does not see where in
    . . . x|. . . .|      its cell a pixel lies; sixteen times fewer places are averaged, and what lies
    . . . .|x . . .|      between the cells' middles is interpolated.
    -------+-------+
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.model.reused_memory import empty
from stackloft_plugins.segmenters.grey import Grey, Levels

CELL = 4
"""Pixels: a cell's side; windows should have a standard deviation of at least one cell."""


@dataclass(frozen=True, slots=True, eq=False)
class CellMeans:
    """Means on a grid of cells over a picture."""

    cells: Grey
    """(rows / CELL, columns / CELL), rounded up"""
    shape: tuple[int, int]
    """(rows, columns) of the picture"""

    def at(self, where: IntArray) -> Grey:
        """Return the means at pixels by their number, row after row, (n)."""
        row, column = np.divmod(where, self.shape[1])
        seen = [
            self.between(column[k : k + _MOST], row[k : k + _MOST]).ravel() for k in range(0, len(row), _MOST)
        ]
        return np.concatenate(seen) if seen else np.zeros(0, np.float32)

    def between(self, x: NDArray[Any], y: NDArray[Any]) -> Grey:
        """Return the means at columns x and rows y of fewer than 2**15 rows, anywhere between the pixels."""
        across, down = (((axis + 0.5) / CELL - 0.5).astype(np.float32) for axis in (x, y))
        seen = cv2.remap(self.cells, across, down, cv2.INTER_LINEAR, None, cv2.BORDER_REPLICATE)
        return np.asarray(seen, np.float32)

    def below(self, levels: Levels) -> BoolArray:
        """Return where a picture's levels lie above the means, (rows, columns)."""
        inside = empty(self.shape, np.bool_)
        for some, means in self._strips():
            np.greater(levels[some], means, out=inside[some])
        return inside

    def taken_off(self, levels: Levels) -> Levels:
        """Return a picture's levels less the means, of the same type."""
        less = empty(levels.shape, levels.dtype)
        for some, means in self._strips():
            off = levels[some] - means
            less[some] = np.rint(off, out=off) if levels.dtype.kind in "iu" else off
        return less

    def _strips(self) -> Iterator[tuple[slice, Grey]]:
        """Yield the means at all pixels, some rows at once, which stay in the processor's cache."""
        rows, columns = self.shape
        for top in range(0, rows, _STRIP):
            some = slice(top, min(top + _STRIP, rows))
            first = max(top // CELL - 1, 0)
            cells = self.cells[first : (top + _STRIP) // CELL + 1]
            size = (self.cells.shape[1] * CELL, len(cells) * CELL)
            wide = cv2.resize(cells, size, interpolation=cv2.INTER_LINEAR)
            yield some, np.asarray(wide[top - first * CELL :][: some.stop - top, :columns], np.float32)


_MOST = 32_000  # OpenCV's remap takes fewer than 2**15 rows
_STRIP = 16 * CELL


def cell_means(
    shape: tuple[int, int], where: IntArray, values: NDArray[np.floating], reach: float, trust: float
) -> CellMeans:
    """Return the mean about each cell.

    Parameters
    ----------
    shape : (rows, columns) of the picture
    where : (n,) array of int
        Pixels by their number, row after row.
    values : (n,) array
        What is known there.
    reach : float
        Pixels: standard deviation of the window.
    trust : float
        Known pixels by all pixels of a window for which the mean of all values counts as much as its own.

    Examples
    --------
    >>> found = cell_means((40, 80), np.array([820, 860]), np.array([1.0, 3.0]), 4.0, 1e-4)
    >>> [round(float(mean), 1) for mean in found.at(np.array([820, 860]))]
    [1.0, 3.0]
    >>> found.taken_off(np.full((40, 80), 3.0, np.float32))[10, [20, 60]].round(1) + 0.0
    array([2., 0.], dtype=float32)
    """
    rows, columns = (-(-side // CELL) for side in shape)
    row, column = np.divmod(where, shape[1])
    cell = row // CELL * columns + column // CELL
    usual: FloatArray = np.asarray(values, np.float64).mean(keepdims=True)
    weight, total = (
        np.bincount(cell, each, rows * columns).astype(np.float32).reshape(rows, columns) / CELL**2
        for each in (None, values - usual)
    )
    near, about = (cv2.GaussianBlur(each, (0, 0), reach / CELL) for each in (weight, total))
    return CellMeans(np.asarray(usual + about / (near + np.float32(trust)), np.float32), shape)
