r"""A triangulated disc carried through layers, its prisms cut into tetrahedra; a pole is one vertex.

::

        pole                 a prism over the triangle a < b < c (by rank) is cut into
       / | \                 (a, b, c, c'), (a, b, b', c'), (a, a', b', c'); neighbours cut the side between
      o--o--o   layer 2      them along the same diagonal, from the lower rank below to the higher above
      |\ |\ |
      o--o--o   layer 1      after Dompierre et al. (1999), How to subdivide pyramids, prisms and hexahedra
      |\ |\ |                into tetrahedra
      o--o--o   plane face
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

IntArray = NDArray[np.int64]


def swept(triangles: IntArray, count: int, layers: int, poles: tuple[bool, bool]) -> IntArray:
    """Return (m, 4) tetrahedra over `layers` copies of a disc of `count` points, copy after copy.

    Parameters
    ----------
    triangles : (t, 3) int array
        Of the disc, counter-clockwise seen from the last layer.
    count : int
    layers : int
        Copies of the disc.
    poles : pair of bool
        Whether a vertex closes the first and the last end; they are numbered after all copies.

    Examples
    --------
    >>> swept(np.array([[0, 1, 2]]), 3, 2, (False, True)).tolist()
    [[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3], [3, 4, 5, 6]]
    """
    parts = [_prisms(triangles, count * k, count * (k + 1)) for k in range(layers - 1)]
    pole = count * layers
    if poles[0]:
        parts.insert(0, np.column_stack([triangles[:, ::-1], np.full(len(triangles), pole)]))
        pole += 1
    if poles[1]:
        top = triangles + count * (layers - 1)
        parts.append(np.column_stack([top, np.full(len(triangles), pole)]))
    return np.concatenate(parts)


def _prisms(triangles: IntArray, below: int, above: int) -> IntArray:
    """Return the tetrahedra of the prisms between two copies."""
    order = np.argsort(triangles, axis=1)
    a, b, c = np.take_along_axis(triangles, order, axis=1).T
    even = np.isin(order[:, 0] * 9 + order[:, 1] * 3 + order[:, 2], (5, 15, 19))  # (0 1 2), (1 2 0), (2 0 1)
    cut = np.stack(
        [
            np.column_stack([a + below, b + below, c + below, c + above]),
            np.column_stack([a + below, b + below, c + above, b + above]),
            np.column_stack([a + below, b + above, c + above, a + above]),
        ]
    )
    cut[:, ~even] = cut[:, ~even][:, :, [0, 2, 1, 3]]
    return np.asarray(cut.reshape(-1, 4))
