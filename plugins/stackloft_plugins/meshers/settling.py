r"""Boundary nodes put in place as far as elements allow.

::

    first all of the way, inner nodes following; then the few boundary nodes whose elements stay turned
    over go half of the way back, and half again, until none is
"""

from __future__ import annotations

import numpy as np

from stackloft.geometry.relaxed_tets import relaxed
from stackloft.geometry.tet_jacobian import jacobian_bounds
from stackloft.model.arrays import BoolArray, FloatArray, IntArray

_HALVES = 4
"""Halvings before a node goes all the way back."""


def settled(straight: FloatArray, placed: FloatArray, elements: IntArray, held: BoolArray) -> FloatArray:
    """Return the nodes with as much of the way from `straight` to `placed` as leaves no element turned over.

    Parameters
    ----------
    straight : (n, 3) array
        Nodes of elements that are all positive, mm.
    placed : (n, 3) array
        The same with the held ones where they belong.
    elements : (m, 4|10|20) int array
    held : (n,) bool array
        Nodes of the boundary.
    """
    wanted = placed.copy()
    for turn in range(_HALVES + 1):
        found = relaxed(straight, wanted, elements, held)
        turned = jacobian_bounds(found[elements]).low <= 0.0
        if not turned.any():
            break
        back = np.zeros(len(straight), dtype=bool)
        back[elements[turned]] = True
        back &= held
        wanted[back] = 0.5 * (wanted + straight)[back] if turn < _HALVES - 1 else straight[back]
    return found
