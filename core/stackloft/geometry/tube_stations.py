r"""Where the rows and columns of a swept mesh lie on a tube of patches.

::

    knots    |   |   |   |   |   |        stations follow knot lines: a patch longer than wanted is cut into
    fine     | | | | | | | | | | |        equal parts, patches much shorter are joined, and lines where the
    coarse   |       |       |   |        surface turns sharply stay whatever their distance
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.bezier_patch import bernstein, bernstein_slope, evaluate
from stackloft.geometry.patch_integrals import gauss_unit

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


def stations(
    lengths: FloatArray, sharp: BoolArray, size: float, least: FloatArray | None = None
) -> FloatArray:
    """Return the stations along a line of patches, in patches: 2.5 is the middle of the third.

    Parameters
    ----------
    lengths : (k,) array
        Of each patch along the line, mm.
    sharp : (k + 1,) bool array
        Knot lines that must be stations; the two ends are.
    size : float
        Longest wanted distance, mm.
    least : (k,) array, optional
        In how many parts a patch is cut at least; one so named is never joined to others.

    Examples
    --------
    >>> line = np.ones(6)
    >>> stations(line, np.zeros(7, bool), 2.1).tolist(), stations(line[:2], np.zeros(3, bool), 0.6).tolist()
    ([0.0, 2.0, 4.0, 6.0], [0.0, 0.5, 1.0, 1.5, 2.0])
    """
    least = np.zeros(len(lengths)) if least is None else least
    kept = sharp.copy()
    kept[0] = kept[-1] = True
    alone = np.flatnonzero(least > 0)
    kept[alone], kept[alone + 1] = True, True
    result: list[float] = [0.0]
    for a, b in pairwise(np.flatnonzero(kept).tolist()):
        joined = _joined(lengths[a:b], size)
        if len(joined) < b - a:
            result += [float(a + k) for k in joined]
            continue
        for k in range(a, b):
            cuts = max(int(np.ceil(lengths[k] / size - 1e-9)), int(least[k]), 1)
            result += [k + j / cuts for j in range(1, cuts + 1)]
    return np.array(result)


def _joined(part: FloatArray, size: float) -> list[int]:
    """Return where groups of neighbouring patches end, none longer than `size` unless it is a single one."""
    along = np.concatenate([[0.0], np.cumsum(part)])
    greedy, start = [], 0
    while start < len(part):
        reach = int(np.searchsorted(along, along[start] + size * (1.0 + 1e-9), side="right")) - 1
        start = max(start + 1, reach)
        greedy.append(start)
    wanted = along[-1] * np.arange(1, len(greedy) + 1) / len(greedy)
    even = [int(np.argmin(np.abs(along - x))) for x in wanted]
    longest = np.diff(along[[0, *even]]).max()
    fits = len(set(even)) == len(even) and longest <= max(size, part.max()) * (1.0 + 1e-9)
    return even if fits else greedy


def tube_lengths(patches: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the length of each row where it is longest, and of each column where it is.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array

    Returns
    -------
    (rows,) array, mm
    (columns,) array, mm
    """
    x, w = gauss_unit(7)
    first, last, slope = bernstein(np.zeros(1)), bernstein(np.ones(1)), bernstein_slope(x)
    along_v = np.linalg.norm(evaluate(patches, slope, first)[:, :, :, 0], axis=-1) @ w
    along_u = np.linalg.norm(evaluate(patches, first, slope)[:, :, 0], axis=-1) @ w
    top = np.linalg.norm(evaluate(patches[-1:], last, slope)[:, :, 0], axis=-1) @ w
    return along_v.max(axis=1), np.asarray(np.concatenate([along_u, top]).max(axis=0))
