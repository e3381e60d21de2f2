r"""The boundary of a tetrahedral mesh: the faces that one element alone has, outward, with all their nodes.

::

    \ | /          a face of two elements is inside; of one, boundary;
    -\|/-          of more, no mesh
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.lagrange_simplex import TET_NODES, face_nodes

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_ORDERS = {count: order for order, count in TET_NODES.items()}


def boundary_faces(elements: IntArray) -> IntArray:
    """Return (b, 3|6|10) node numbers of the boundary faces, outward, by element.

    Raises
    ------
    ValueError
        A face that more than two elements have, or that two have on the same side.

    Examples
    --------
    >>> boundary_faces(np.array([[0, 1, 2, 3], [1, 2, 3, 4]]))[:, :3].tolist()
    [[0, 1, 3], [2, 0, 3], [0, 2, 1], [1, 2, 4], [2, 3, 4], [3, 1, 4]]
    """
    order = _ORDERS[elements.shape[1]]
    every = elements[:, face_nodes(order)].reshape(-1, face_nodes(order).shape[1])
    corners = np.sort(every[:, :3], axis=1)
    _, which, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    which = which.ravel()
    if (count > 2).any():
        message = f"{int((count > 2).sum())} faces belong to more than two elements"
        raise ValueError(message)
    a, b, c = every[:, 0], every[:, 1], every[:, 2]
    even = ((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b))
    turning = np.bincount(which, np.where(even, 1.0, -1.0))
    if (turning[count == 2] != 0.0).any():
        message = f"{int((turning[count == 2] != 0.0).sum())} faces have both their elements on one side"
        raise ValueError(message)
    return np.asarray(every[count[which] == 1])
