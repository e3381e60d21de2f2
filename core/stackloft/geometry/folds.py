"""Where a skin folds: half-way between rows its sections cross themselves, or it runs back along the axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.bezier_patch import bernstein, evaluate
from stackloft.geometry.simple_polygon import crosses_itself

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

_HALF = bernstein(np.array([0.5]))
_ALONG = bernstein(np.array([0.0, 0.5]))
_ACROSS = bernstein(np.linspace(0.0, 1.0, 9))


def folded_rows(patches: FloatArray) -> BoolArray:
    """Return which rows of patches fold.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array
        Bézier control points [v, u], mm; z is constant along each row's rims and increases across it.

    Returns
    -------
    (rows,) bool array
        True where z does not increase all along v (the surface's Jacobian changes sign there), or where
        the section half-way crosses itself.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(12) / 12
    >>> ring = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    >>> from stackloft.geometry.skin import Rows, skin
    >>> tube = np.stack([ring, ring + [0, 0, 1.0], ring + [0, 0, 2.0]])
    >>> folded_rows(skin(Rows(tube, np.zeros((3, 12), bool), np.zeros(3, bool), (None, None)))).tolist()
    [False, False]
    """
    half = evaluate(patches, _HALF, _ALONG)[:, :, 0, :, :2]
    crossing = crosses_itself(half.reshape(len(patches), -1, 2))
    z = np.einsum("av,rcv->rca", _ACROSS, patches[:, :, :, 0, 2])
    rise = np.diff(z, axis=-1)
    length = np.abs(z[..., -1:] - z[..., :1])
    back = (rise < -1e-6 * np.maximum(length, 1e-300)).any(axis=(1, 2))
    return np.asarray(crossing | back)
