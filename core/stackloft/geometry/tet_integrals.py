r"""Volume and area of curved elements: u = 1 integrated by Gauss rules.

::

    V = Σ elements Σ g  w_g det J(ξ_g)          S = Σ boundary faces Σ g  w_g |X_ξ × X_η|(ξ_g)

det J of order p is a polynomial of degree 3(p − 1): from that degree on V is exact. |X_ξ × X_η|
is one of degree 2(p − 1) on plane faces, where S is exact, too; on curved ones its rule converges.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.lagrange_simplex import TET_NODES, TRIANGLE_NODES, shape_slopes
from stackloft.geometry.simplex_gauss import simplex_gauss

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_TETS = {count: order for order, count in TET_NODES.items()}
_TRIANGLES = {count: order for order, count in TRIANGLE_NODES.items()}
_BATCH = 20_000


def exact_volume_degree(order: int) -> int:
    """Return the degree from which on a rule gives the volume of elements of `order` exactly.

    Examples
    --------
    >>> [exact_volume_degree(order) for order in (1, 2, 3)]
    [1, 3, 6]
    """
    return max(1, 3 * (order - 1))


def elements_volume(nodes: FloatArray, elements: IntArray, degree: int) -> float:
    """Return the signed volume of elements (m, 4|10|20), mm³, by the Gauss rule of `degree`."""
    _, weights = simplex_gauss(3, degree)
    slopes = shape_slopes(3, _TETS[elements.shape[1]], simplex_gauss(3, degree)[0])
    local = nodes - nodes.mean(axis=0)
    total = 0.0
    for start in range(0, len(elements), _BATCH):
        part = local[elements[start : start + _BATCH]]
        a, b, c = (slopes[axis] @ part for axis in range(3))
        total += float(np.einsum("mgd,mgd,g->", a, np.cross(b, c), weights))
    return total


def faces_area(nodes: FloatArray, faces: IntArray, degree: int) -> float:
    """Return the area of faces (b, 3|6|10), mm², by the Gauss rule of `degree`."""
    points, weights = simplex_gauss(2, degree)
    slopes = shape_slopes(2, _TRIANGLES[faces.shape[1]], points)
    part = (nodes - nodes.mean(axis=0))[faces]
    normal = np.cross(slopes[0] @ part, slopes[1] @ part)
    return float((np.linalg.norm(normal, axis=2) @ weights).sum())
