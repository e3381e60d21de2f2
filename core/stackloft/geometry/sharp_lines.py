"""Where a tube of patches turns sharply: lines that element edges must follow."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def sharp_columns(patches: FloatArray, angle: float = 10.0) -> NDArray[np.bool_]:
    """Return (columns,) where a tube's neighbouring patches meet at more than `angle` degrees, in any row.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array
        The line asked about is the start (u = 0) of each column.
    """
    into, out = patches[:, :, :, 3] - patches[:, :, :, 2], patches[:, :, :, 1] - patches[:, :, :, 0]
    return np.asarray(_turning(np.roll(into, 1, axis=1), out, angle).any(axis=(0, 2)), dtype=bool)


def sharp_rows(patches: FloatArray, angle: float = 10.0) -> NDArray[np.bool_]:
    """Return (rows + 1,) where a tube turns by more than `angle` degrees across sections; both ends count.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array
        The line asked about is the start (v = 0) of each row; the last is the end of the last row.
    """
    into, out = patches[:-1, :, 3] - patches[:-1, :, 2], patches[1:, :, 1] - patches[1:, :, 0]
    inner = _turning(into, out, angle).any(axis=(1, 2))
    return np.concatenate([[True], inner, [True]])


def _turning(into: FloatArray, out: FloatArray, angle: float) -> NDArray[np.bool_]:
    length = np.linalg.norm(into, axis=-1) * np.linalg.norm(out, axis=-1)
    whole = (into * out).sum(axis=-1)
    largest = length.max() if length.size else 0.0
    return np.asarray((length > 1e-12 * largest) & (whole < np.cos(np.radians(angle)) * length))
