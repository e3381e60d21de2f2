r"""The nodes of a swept tube at order 2 and 3: on the exact surface by their parameters, straight inside.

::

    (v₀, u₀) o-----x-----o (v₁, u₁)     a side node lies where the means of its vertices' parameters say; at a
              \         /               pole u is the mean of the others', which is the pole's polar chart:
               x       x                (1 − share of the pole) is the radius there, and the node is as far
                \     /                 along it as it is along the edge
                  pole
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.raised_tets import RaisedTets, raised
from stackloft.geometry.relaxed_tets import relaxed
from stackloft.geometry.swept_tube import SweptTube, tube_points
from stackloft.geometry.tet_boundary import boundary_faces

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class SweptNodes:
    """Curved elements."""

    nodes: FloatArray
    """(n, 3) mm"""
    elements: IntArray
    """(m, 4|10|20)"""
    faces: IntArray
    """(b, 3|6|10) outward"""
    ends: IntArray
    """(b,) 0: side, 1: plane face at the first end, 2: at the last"""


def swept_nodes(
    tubes: tuple[FloatArray, ...], tube: SweptTube, order: int, planes: tuple[bool, bool]
) -> SweptNodes:
    """Return the tube's elements at `order`, boundary on the patches, inner nodes relaxed where needed.

    Parameters
    ----------
    tubes : (rows, columns, 4, 4, 3) arrays
        What `tube` was swept through or between, mm.
    tube : SweptTube
    order : int
        1, 2 or 3.
    planes : pair of bool
        Where a plane face ends the tube.
    """
    high = raised(tube.elements, len(tube.vertices), order)
    faces = boundary_faces(high.elements)
    ends = _ends(tube, faces, len(tubes[0]), planes)
    straight = high.straight(tube.vertices)
    placed = straight.copy()
    skin = tube.skin[faces[:, :3]].max(axis=1)  # a pole's is its tube's
    for k, patches in enumerate(tubes):
        side = np.unique(faces[(ends == 0) & (skin == k)])
        v, u = _parameters(high, side, tube.at, patches.shape[1])
        placed[side] = tube_points(patches, v, u)
    held = np.zeros(len(placed), dtype=bool)
    held[faces] = True
    return SweptNodes(relaxed(straight, placed, high.elements, held), high.elements, faces, ends)


def _ends(tube: SweptTube, faces: IntArray, rows: int, planes: tuple[bool, bool]) -> IntArray:
    """Return which end each boundary face belongs to: the one in whose layer all its vertices lie."""
    ends = np.zeros(len(faces), dtype=np.int64)
    for number, (plane, level) in enumerate(zip(planes, (0.0, float(rows)), strict=True), start=1):
        if plane:
            ends[_in_layer(tube, faces, level)] = number
    return ends


def _in_layer(tube: SweptTube, faces: IntArray, level: float) -> NDArray[np.bool_]:
    """Return which faces lie in one layer, whose vertices are numbered one after the other."""
    of_level = np.flatnonzero(tube.at[:, 0] == level)
    inside = (faces[:, :3] >= of_level.min()) & (faces[:, :3] < of_level.min() + tube.layer)
    return np.asarray(inside.all(axis=1), dtype=bool)


def _parameters(
    high: RaisedTets, nodes: IntArray, at: FloatArray, columns: int
) -> tuple[FloatArray, FloatArray]:
    """Return (v, u) of side nodes from their vertices'; u is taken the short way round the loop."""
    share = high.shares[nodes]
    own = at[high.parents[nodes]]
    v = (np.where(share > 0.0, own[:, :, 0], 0.0) * share).sum(axis=1)
    known = (share > 0.0) & ~np.isnan(own[:, :, 1])
    first = np.argmax(known, axis=1)
    start = np.nan_to_num(np.take_along_axis(own[:, :, 1], first[:, None], axis=1))
    off = (np.nan_to_num(own[:, :, 1]) - start + 0.5 * columns) % columns - 0.5 * columns
    weight = np.where(known, share, 0.0)
    total = weight.sum(axis=1)
    u = start[:, 0] + (off * weight).sum(axis=1) / np.where(total > 0.0, total, 1.0)
    return v, u
