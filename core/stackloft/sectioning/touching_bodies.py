r"""Bodies that touch, cut apart at the neck between them.

::

      distance to the background            16 |   /\        /\
                                               |  /  \      /  \         two summits of 16 and 15 pixels,
        (  a  )(  b  )                       5 | /    \____/    \        the pass between them 5 high:
                                               +------------------       a neck of a third of the width

The distance to the background has its summits inside the bodies and a pass at each neck (Beucher &
Lantuéjoul 1979). Two basins of its watershed are one body when the pass is at least `neck` times as high as
the lower summit, two when it is lower; the pass between parts of one slender body is nearly as high as its
summits. Whether a narrow neck is contact or waist nobody can tell from shape alone, so that this is done on
request.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.sectioning.slice_pieces import Corner, Pieces

MOST_VOXELS = 6_000_000
"""Voxels that the distances are worked out on; larger bodies are looked at coarser."""
_DIFFERENT = 0.02  # part of a summit's height below which it is no summit of its own
Labels = NDArray[np.int32]


def basins(body: BoolArray, spacing: tuple[float, float, float], neck: float) -> Labels:
    """Return the number of the body that each voxel belongs to, from 1; 0: background.

    Parameters
    ----------
    body : (slices, rows, columns) array
    spacing : tuple of float
        mm, along slices, rows and columns.
    neck : float
        Width of a neck, as a part of the width of the thinner body, below which it is cut.

    Examples
    --------
    >>> z, y, x = np.ogrid[-12:13, -12:13, -12:32]
    >>> two = (z**2 + y**2 + x**2 < 100) | (z**2 + y**2 + (x - 18) ** 2 < 100)
    >>> int(basins(two, (1.0, 1.0, 1.0), 0.7).max()), int(basins(two, (1.0, 1.0, 1.0), 0.3).max())
    (2, 1)
    """
    from scipy.ndimage import distance_transform_edt, label  # noqa: PLC0415 - for a rare request
    from skimage.morphology import h_maxima  # noqa: PLC0415
    from skimage.segmentation import watershed  # noqa: PLC0415

    framed = np.pad(body, 1)
    height: FloatArray = distance_transform_edt(framed, sampling=spacing)
    peaks = h_maxima(height, _DIFFERENT * float(height.max()))  # type: ignore[no-untyped-call]
    summits, _ = label(peaks, np.ones((3, 3, 3)))
    parts: Labels = watershed(-height, summits, mask=framed).astype(np.int32)  # type: ignore[no-untyped-call]
    owner = _joined(parts, height, neck)
    return owner[parts][1:-1, 1:-1, 1:-1]


def _joined(parts: Labels, height: FloatArray, neck: float) -> Labels:
    """Return the body of each part, those with high passes between them being one."""
    count = int(parts.max())
    top = np.zeros(count + 1)
    np.maximum.at(top, parts.ravel(), height.ravel())
    owner = np.arange(count + 1)
    for (a, b), pass_height in sorted(_passes(parts, height).items(), key=lambda item: -item[1]):
        first, second = _root(owner, a), _root(owner, b)
        if first != second and pass_height >= neck * min(top[first], top[second]):
            high, low = (first, second) if top[first] >= top[second] else (second, first)
            owner[low] = high
    roots = np.array([_root(owner, k) for k in range(count + 1)])
    _, numbers = np.unique(roots, return_inverse=True)
    return numbers.astype(np.int32)


def _root(owner: IntArray, k: int) -> int:
    while owner[k] != k:
        k = int(owner[k])
    return k


def _passes(parts: Labels, height: FloatArray) -> dict[tuple[int, int], float]:
    """Return the highest place at which each two parts touch."""
    found: dict[tuple[int, int], float] = {}
    for axis in range(3):
        low, high = (np.moveaxis(parts, axis, 0)[cut] for cut in (slice(None, -1), slice(1, None)))
        beside = (low != high) & (low > 0) & (high > 0)
        pairs = np.sort(np.stack([low[beside], high[beside]], axis=1), axis=1)
        levels = np.moveaxis(height, axis, 0)
        at = np.minimum(levels[:-1][beside], levels[1:][beside])
        unique, which = np.unique(pairs, axis=0, return_inverse=True)
        best = np.zeros(len(unique))
        np.maximum.at(best, which.ravel(), at)
        for (a, b), one in zip(unique.tolist(), best.tolist(), strict=True):
            found[a, b] = max(found.get((a, b), 0.0), one)
    return found


def stride_for(shape: tuple[int, int, int]) -> int:
    """Return every how many voxels along rows and columns a body is looked at.

    Examples
    --------
    >>> stride_for((200, 100, 100)), stride_for((500, 400, 400))
    (1, 4)
    """
    return max(1, math.ceil(math.sqrt(math.prod(shape) / MOST_VOXELS)))


def on_window(pieces: Pieces, corner: Corner, window: tuple[int, int, int, int], stride: int) -> Pieces:
    """Return every `stride`-th pixel of a slice's pieces on a window (top, left, bottom, right)."""
    top, left, bottom, right = window
    whole = np.zeros((bottom - top, right - left), dtype=pieces.dtype)
    row, column = corner[0] - top, corner[1] - left
    whole[row : row + pieces.shape[0], column : column + pieces.shape[1]] = pieces
    return whole[::stride, ::stride]
