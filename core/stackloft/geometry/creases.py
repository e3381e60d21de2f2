r"""Sections at which the body's side turns sharply: a double cone's equator, the two edges of a step.

::

      /\  one sharp row           ____|     two or three sharp rows between straight ones: a step,
     /  \ between straight ones   |          a flange; smooth splines would overshoot there
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

SHARP = np.radians(25.0)
"""Smallest turn of a crease."""
QUIET = 0.2
"""Largest turn of the neighbouring sections, as a fraction of the crease's."""
LONGEST = 3
"""Most sharp sections in a row: a crease, a step, a flange; a longer run is a strongly bent body."""


def find_creases(rows: FloatArray) -> BoolArray:
    """Return the rows at which the columns turn sharply while they run smoothly on both sides.

    Parameters
    ----------
    rows : (n, N, 3) array
        Corresponding points of the rows, mm, poles included.

    Returns
    -------
    (n,) bool array

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(16) / 16
    >>> ring = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    >>> radius, z = [1.0, 2.0, 3.0, 2.0, 1.0], [-2.0, -1.0, 0.0, 1.0, 2.0]
    >>> find_creases(np.stack([ring * r + [0, 0, h] for r, h in zip(radius, z)])).tolist()
    [False, False, True, False, False]
    >>> radius, z = [1.0, 1.0, 1.0, 3.0, 3.0, 3.0], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    >>> find_creases(np.stack([ring * r + [0, 0, h] for r, h in zip(radius, z)])).tolist()
    [False, False, True, True, False, False]
    """
    n = len(rows)
    creases = np.zeros(n, dtype=bool)
    if n < 5:
        return creases
    step = np.diff(rows, axis=0)
    length = np.linalg.norm(step, axis=2, keepdims=True)
    direction = step / np.maximum(length, 1e-300)
    cosine = np.clip((direction[1:] * direction[:-1]).sum(axis=2), -1.0, 1.0)
    turn = np.arccos(cosine).mean(axis=1)  # of rows 1 … n - 2
    padded = np.concatenate([[np.inf], turn, [np.inf]])  # what lies beyond the first and last row is unknown
    for first, last in _runs(turn > SHARP):
        flanks = max(padded[first], padded[last + 2])
        if last - first < LONGEST and flanks < QUIET * turn[first : last + 1].min():
            creases[first + 1 : last + 2] = True
    return creases


def _runs(marked: BoolArray) -> list[tuple[int, int]]:
    """Return first and last index of every run of marked rows."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int)))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]
