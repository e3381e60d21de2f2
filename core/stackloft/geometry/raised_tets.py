r"""Straight tetrahedra raised to order 2 or 3: nodes on edges and faces, shared where elements meet.

::

    0-------1   →   0---4---1   →   0--4--5--1      edge nodes from an edge's first vertex to its second,
                                                    as the element runs it; the face node in the middle
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.lagrange_simplex import TET_EDGES, TET_FACES

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class RaisedTets:
    """Elements of some order, and of which vertices each node is made."""

    elements: IntArray
    """(m, 4|10|20) node numbers; vertices keep theirs"""
    parents: IntArray
    """(n, 3) the vertices of each node; the last repeated where there are fewer"""
    shares: FloatArray
    """(n, 3) the part of each in the straight node; sums to 1"""

    def straight(self, vertices: FloatArray) -> FloatArray:
        """Return (n, 3) where the nodes lie when every edge is straight."""
        return np.asarray((vertices[self.parents] * self.shares[:, :, None]).sum(axis=1))


def raised(elements: IntArray, count: int, order: int) -> RaisedTets:
    """Return the elements at `order`, with `count` vertices first among the nodes.

    Parameters
    ----------
    elements : (m, 4) int array
    count : int
        Vertices in all.
    order : int
        1, 2 or 3.

    Examples
    --------
    >>> found = raised(np.array([[0, 1, 2, 3], [1, 2, 3, 4]]), 5, 2)
    >>> found.elements.shape, len(found.parents)
    ((2, 10), 14)
    """
    own = np.arange(count)
    parents = [np.column_stack([own, own, own])]
    shares = [np.tile([1.0, 0.0, 0.0], (count, 1))]
    columns = [elements]
    if order > 1:
        pairs = elements[:, TET_EDGES]
        ends, which = _shared(pairs.reshape(-1, 2))
        inner = order - 1
        first = count + which.reshape(-1, len(TET_EDGES)) * inner
        along = pairs[:, :, 0] < pairs[:, :, 1]
        steps = [np.where(along, j, inner - 1 - j) for j in range(inner)]
        columns.append(np.stack([first + step for step in steps], axis=2).reshape(len(elements), -1))
        part = np.arange(1, order) / order
        lower, upper = ends[:, 0].repeat(inner), ends[:, 1].repeat(inner)
        parents.append(np.column_stack([lower, upper, upper]))
        part = np.tile(part, len(ends))
        shares.append(np.column_stack([1.0 - part, part, np.zeros(len(part))]))
    if order == 3:
        corners, which = _shared(elements[:, TET_FACES].reshape(-1, 3))
        columns.append(which.reshape(-1, len(TET_FACES)) + sum(map(len, parents)))
        parents.append(corners)
        shares.append(np.full((len(corners), 3), 1.0 / 3.0))
    return RaisedTets(np.hstack(columns), np.concatenate(parents), np.concatenate(shares))


def _shared(rows: IntArray) -> tuple[IntArray, IntArray]:
    """Return the different rows, each in ascending order, and which one each row is."""
    different, which = np.unique(np.sort(rows, axis=1), axis=0, return_inverse=True)
    return different, which.ravel()
