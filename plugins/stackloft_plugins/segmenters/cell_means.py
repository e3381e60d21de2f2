r"""Values known at some pixels, averaged in a Gaussian window about each pixel, on a grid of cells.

::

    . . x .|. . . .|      x: a pixel with a value. A window much wider than a cell does not see where in
    . . . x|. . . .|      its cell a pixel lies; sixteen times fewer places are averaged, and what lies
    . . . .|x . . .|      between the cells' middles is interpolated.
    -------+-------+
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, IntArray
from stackloft_plugins.segmenters.grey import Grey

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
        y, x = (((axis + 0.5) / CELL - 0.5).astype(np.float32) for axis in (row, column))
        seen = [
            cv2.remap(self.cells, x[k : k + _MOST], y[k : k + _MOST], cv2.INTER_LINEAR, None, _EDGE)
            for k in range(0, len(x), _MOST)
        ]
        return np.concatenate([part.ravel() for part in seen]) if seen else np.zeros(0, np.float32)

    def everywhere(self) -> Grey:
        """Return the means at all pixels, (rows, columns)."""
        rows, columns = self.cells.shape
        size = (columns * CELL, rows * CELL)
        wide = cv2.resize(self.cells, size, interpolation=cv2.INTER_LINEAR)
        return np.asarray(wide[: self.shape[0], : self.shape[1]], dtype=np.float32)


_MOST = 32_000  # OpenCV's remap takes fewer than 2**15 rows
_EDGE = cv2.BORDER_REPLICATE


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
    >>> [round(float(mean), 1) for mean in found.at(np.array([820, 860]))], found.everywhere().shape
    ([1.0, 3.0], (40, 80))
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
