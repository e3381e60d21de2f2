r"""Outlines with holes drawn as one curve ("keyhole"), cut open into their loops.

::

      +-----------------+             one polygon goes round the outline, along a bridge to the hole,
      |   +-------+     |             round the hole the other way, and back over the same bridge
      |   | hole  |=====+  bridge
      |   +-------+     |
      +-----------------+

Source: DICOM PS3.3, C.8.8.6.3: a hole is drawn by a narrow channel from the outline.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

SAME = 1e-4
"""Vertices nearer than this fraction of the outline's width are one."""


def split_keyhole(points: FloatArray, same: float = SAME) -> list[FloatArray]:
    """Return the loops of a polygon that runs over the same vertices or bridges twice.

    Parameters
    ----------
    points : (k, 2) array
        Vertices of a closed polygon, the last joined to the first.
    same : float
        Vertices nearer than this fraction of the polygon's width are one.

    Returns
    -------
    list of (k, 2) array
        Loops of at least 3 vertices, none of which touches itself in a vertex; the polygon as it is when
        none of its vertices is met twice. The loops' areas, holes subtracted, are the polygon's.

    Examples
    --------
    >>> outline = [(0, 0), (9, 0), (9, 5), (9, 9), (0, 9)]
    >>> hole = [(6, 5), (6, 3), (3, 3), (3, 6), (6, 6)]
    >>> drawn = np.array([*outline[:3], *hole, hole[0], *outline[2:]], dtype=float)
    >>> [len(loop) for loop in split_keyhole(drawn)]
    [5, 5]
    """
    numbers = _vertex_numbers(points, same * float(np.ptp(points, axis=0).max()))
    path: list[int] = []
    place: dict[int, int] = {}
    loops: list[FloatArray] = []
    for k, number in enumerate(numbers):
        if number in place:  # the path has closed on itself: what lies between is a loop of its own
            start = place[number]
            loop = path[start:]
            for passed in path[start + 1 :]:
                del place[numbers[passed]]
            del path[start + 1 :]
            if len(loop) >= 3:
                loops.append(points[loop])
            continue
        place[number] = len(path)
        path.append(k)
    if len(path) >= 3:
        loops.append(points[path])
    return loops


def _vertex_numbers(points: FloatArray, near: float) -> list[int]:
    """Return a number for every vertex, the same for vertices that are one."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - only where contours are read

    numbers = list(range(len(points)))
    pairs = cKDTree(points).query_pairs(near, output_type="ndarray")
    for a, b in pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))].tolist():
        numbers[b] = min(numbers[b], numbers[a])
    return numbers
