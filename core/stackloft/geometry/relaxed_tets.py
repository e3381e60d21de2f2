r"""Inner nodes moved so that no curved element turns over.

::

    boundary nodes on the surface        inner nodes follow, as far as elements need it
    o--o--o   →   o´`o´`o                1. not at all: the curved elements may be valid as they are
     \ | /         \ | /                 2. as a stretched body would: K·d = 0, thin elements stiff
       o             o                   3. the elements still turned over, and their neighbours, pushed
                                            until every Bézier coefficient of det J is positive enough

After Persson & Peraire (2009), Curved mesh generation and mesh refinement using Lagrangian solid mechanics,
AIAA 2009-949 (2); Toulorge et al. (2013), Robust untangling of curvilinear meshes, J. Comp. Phys. 254:8 (3).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import splu

from stackloft.geometry.lagrange_simplex import TET_NODES, exponents, shape_slopes
from stackloft.geometry.simplex_gauss import simplex_gauss
from stackloft.geometry.tet_jacobian import bernstein_inverse, jacobian_bounds, jacobian_scale

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

_ORDERS = {count: order for order, count in TET_NODES.items()}

ENOUGH = 0.02
"""Scaled Jacobian that inner nodes are moved for where elements would turn over."""
GOOD = 0.05
"""Scaled Jacobian below which a bent element is poor, when it has lost half of what it had when straight."""
ROUNDS = 4
"""Most rounds of pushing, each on a wider neighbourhood."""


def relaxed(straight: FloatArray, placed: FloatArray, elements: IntArray, held: BoolArray) -> FloatArray:
    """Return the nodes with the inner ones moved where elements would turn over or all but.

    Parameters
    ----------
    straight : (n, 3) array
        Nodes of straight elements that are all positive, mm.
    placed : (n, 3) array
        The same with the held ones where they belong.
    elements : (m, 4|10|20) int array
    held : (n,) bool array
        Nodes that may not move: those of the boundary.

    Returns
    -------
    (n, 3) array
        `placed` itself when no element is poor. Whether one is still turned over is for the caller to ask.
    """
    low = jacobian_bounds(placed[elements]).low
    if (low > 0.0).all():
        return _lifted(straight, placed, elements, held)
    bent = _elastic(straight, placed, elements, held)
    if (jacobian_bounds(bent[elements]).low > 0.0).sum() < (low > 0.0).sum():
        bent = placed
    for wider in range(1, ROUNDS + 1):
        turned = jacobian_bounds(bent[elements]).low <= 0.0
        if not turned.any():
            break
        bent = _pushed(bent, elements, held, turned, wider, 2.0 * ENOUGH, 200)
    return _lifted(straight, bent, elements, held)


def _lifted(straight: FloatArray, nodes: FloatArray, elements: IntArray, held: BoolArray) -> FloatArray:
    """Return the nodes with the inner ones moved away from elements that bending has all but turned over."""
    had = jacobian_bounds(straight[elements]).low
    low = jacobian_bounds(nodes[elements]).low
    for wider in (1, 2):
        poor = (low < GOOD) & (low < 0.5 * had)
        if not poor.any() or low.min() <= 0.0:
            break
        moved = _pushed(nodes, elements, held, poor, wider, 2.0 * GOOD, 60)
        after = jacobian_bounds(moved[elements]).low
        if after.min() < low.min() or (after < GOOD).sum() >= (low < GOOD).sum():
            break
        nodes, low = moved, after
    return nodes


def _elastic(straight: FloatArray, placed: FloatArray, elements: IntArray, held: BoolArray) -> FloatArray:
    """Return the nodes after the displacement of the held ones has spread by Laplace's equation."""
    order = _ORDERS[elements.shape[1]]
    corners = straight[elements[:, :4]]
    frame = (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
    inverse = np.linalg.inv(frame)
    metric = inverse @ inverse.transpose(0, 2, 1)
    blocks = np.einsum("mab,abij->mij", metric, _stiffness(order))
    k = elements.shape[1]
    rows = np.repeat(elements, k, axis=1).ravel()
    columns = np.tile(elements, (1, k)).ravel()
    whole = csr_array((blocks.ravel(), (rows, columns)), shape=(len(straight),) * 2)
    free = np.flatnonzero(~held)
    load = -(whole[free][:, np.flatnonzero(held)] @ (placed - straight)[held])
    result = placed.copy()
    result[free] = straight[free] + splu(csc_array(whole[free][:, free])).solve(load)
    return result


@lru_cache
def _stiffness(order: int) -> FloatArray:
    """Return ∫ ∂ₐNᵢ ∂ᵦNⱼ over the unit tetrahedron, (3, 3, k, k)."""
    points, weights = simplex_gauss(3, 2 * order - 2 or 1)
    slopes = shape_slopes(3, order, points)
    return np.asarray(np.einsum("g,agi,bgj->abij", weights, slopes, slopes))


def _pushed(
    nodes: FloatArray,
    elements: IntArray,
    held: BoolArray,
    turned: BoolArray,
    wider: int,
    wanted: float,
    steps: int,
) -> FloatArray:
    """Return the nodes after those near turned elements have been moved to lift coefficients to `wanted`."""
    near = np.zeros(len(nodes), dtype=bool)
    chosen = turned
    for _ in range(wider):
        near[elements[chosen]] = True
        chosen = np.asarray(near[elements].any(axis=1), dtype=bool)
    free = np.flatnonzero(near & ~held)
    if not len(free):
        return nodes
    part = elements[chosen]
    size = float(np.ptp(nodes[part[:, :4]], axis=1).mean())
    scale = jacobian_scale(nodes[part])
    start = nodes[free].ravel()

    def cost(x: FloatArray) -> tuple[float, FloatArray]:
        moved = nodes.copy()
        moved[free] = x.reshape(-1, 3) * size
        value, slope = _shortfall(moved, part, scale, wanted)
        return value, (slope[free] * size).ravel()

    found = minimize(cost, start / size, jac=True, method="L-BFGS-B", options={"maxiter": steps})
    result = nodes.copy()
    result[free] = found.x.reshape(-1, 3) * size
    return result


def _shortfall(
    nodes: FloatArray, elements: IntArray, scale: FloatArray, wanted: float
) -> tuple[float, FloatArray]:
    """Return Σ max(0, wanted − coefficient)² over all Bézier coefficients of det J, and its slope, (n, 3)."""
    order = _ORDERS[elements.shape[1]]
    degree = 3 * (order - 1)
    slopes = shape_slopes(3, order, exponents(3, degree) / max(degree, 1))
    a, b, c = (slopes[axis] @ nodes[elements] for axis in range(3))
    minors = (np.cross(b, c), np.cross(c, a), np.cross(a, b))
    inverse = bernstein_inverse(degree)
    coefficients = (a * minors[0]).sum(axis=2) @ inverse.T * scale[:, None]
    lack = np.maximum(wanted - coefficients, 0.0)
    weight = -2.0 * (lack * scale[:, None]) @ inverse
    gradient = sum(np.einsum("mg,mgd,gi->mid", weight, minors[k], slopes[k]) for k in range(3))
    total = np.zeros_like(nodes)
    np.add.at(total, elements.ravel(), np.asarray(gradient).reshape(-1, 3))
    return float((lack**2).sum()), total
