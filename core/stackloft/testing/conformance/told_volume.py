r"""A scan of which everything is known, for readers to be held against.

::

    world = origin + column·s_c·u + row·s_r·(v) + z_k·(w + shear·v)      u, v, w: columns of `axes`

Everything is odd on purpose: sizes that are no multiple of two, places far from zero, spacings that differ.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray

SHAPE = (37, 53)
SLICES = 5


@dataclass(frozen=True, slots=True, eq=False)
class ToldVolume:
    """Slices with their place in space; a format that cannot hold something says NotImplementedError."""

    pictures: NDArray[np.generic]
    """(m, rows, columns) any real dtype, byte order and memory layout"""
    positions: FloatArray
    """(m) mm along the normal"""
    spacing: tuple[float, float]
    """(row, column) mm"""
    origin: FloatArray = field(default_factory=lambda: np.zeros(3))
    """(3) mm, where the first pixel of a slice at position 0 lies; LPS for patients"""
    axes: FloatArray = field(default_factory=lambda: np.eye(3))
    """(3, 3) unit columns: along a row, down the rows, along the slices' normal"""
    shear: float = 0.0
    """mm by which pictures move down the rows for each mm along the normal"""

    @property
    def even(self) -> bool:
        """Whether neighbouring slices are equally far apart."""
        gaps = np.diff(self.positions)
        return bool(np.ptp(gaps) < 1e-9)

    @property
    def placed(self) -> bool:
        """Whether it lies anywhere else than upright at the origin."""
        upright = np.array_equal(self.axes, np.eye(3)) and not self.origin.any()
        return not upright or self.shear != 0.0

    def affine(self) -> FloatArray:
        """Return the (4, 4) matrix from (column, row, position, 1) to the world."""
        row, column = self.spacing
        u, v, w = self.axes.T
        matrix = np.eye(4)
        matrix[:3] = np.column_stack([column * u, row * v, w + self.shear * v, self.origin])
        return matrix


def told(
    dtype: str = "<i2", *, positions: FloatArray | None = None, fortran: bool = False, **place: object
) -> ToldVolume:
    """Return a volume of noise over the range of `dtype` (byte order included), placed as told.

    Examples
    --------
    >>> volume = told(">u2")
    >>> volume.pictures.shape, volume.pictures.dtype.str, volume.even
    ((5, 37, 53), '>u2', True)
    """
    z = 1.7 * np.arange(SLICES) if positions is None else positions
    kind = np.dtype(dtype)
    random = np.random.default_rng(7)
    size = (len(z), *SHAPE)
    values: NDArray[np.generic]
    if kind.kind == "f":
        values = random.normal(0.0, 300.0, size)
    else:
        low, high = (-1024, 3071) if kind.kind == "i" else (0, np.iinfo(kind).max)
        values = random.integers(low, high, size, endpoint=True)
    pictures = values.astype(kind, order="F" if fortran else "C")
    return ToldVolume(pictures, z, (0.7, 0.45), **place)  # type: ignore[arg-type]
