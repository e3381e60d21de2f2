r"""A mesh of straight or curved tetrahedra with a named boundary.

::

        3                 nodes of an element: vertices, then edge nodes, then face nodes, in the order of
       /|\                `stackloft.geometry.lagrange_simplex` (VTK's); order 1: 4 nodes, 2: 10, 3: 20
      / | \
     0--|--2              a boundary face: its vertices counter-clockwise seen from outside, then its edge
      \ | /               nodes, then its inner node; order 1: 3 nodes, 2: 6, 3: 10
       \|/
        1                 bench millimetres
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from stackloft.geometry.lagrange_simplex import TET_NODES
from stackloft.geometry.tet_jacobian import jacobian_bounds
from stackloft.model.arrays import FloatArray, IntArray, frozen_ints
from stackloft.model.bias import Bias
from stackloft.model.notices import Notice

_ORDERS = {count: order for order, count in TET_NODES.items()}

BODY = "body"
"""Name of the volume group."""
SIDE, FIRST_FACE, LAST_FACE = "side", "first-face", "last-face"
"""Names of boundary groups: what goes through the sections, and the plane faces that end it."""


@dataclass(frozen=True, slots=True, eq=False)
class TetMesh:
    """Tetrahedra, all positive, and the faces of their boundary."""

    nodes: FloatArray
    """(n, 3) mm"""
    elements: IntArray
    """(m, 4|10|20) indices into `nodes`"""
    faces: IntArray
    """(b, 3|6|10) indices into `nodes`: every boundary face once, outward"""
    groups: IntArray = field(default_factory=lambda: frozen_ints([]))
    """(b,) index into `group_names` of each boundary face; empty: all are the first group"""
    group_names: tuple[str, ...] = (SIDE,)
    """Names of the boundary groups; the elements themselves are the group ``body``."""
    notices: tuple[Notice, ...] = ()
    volume_bias: Bias | None = None
    area_bias: Bias | None = None
    """How far off volume and area may be, when this mesh's maker knows."""
    volume_uncertainty: float | None = None
    """mm³: standard uncertainty that the mesh itself adds (a mesher that is not reproducible)."""
    area_uncertainty: float | None = None
    """mm²: likewise."""

    @property
    def order(self) -> int:
        """1, 2 or 3: the polynomial degree of the elements."""
        return _ORDERS[self.elements.shape[1]]

    def group_of_faces(self) -> IntArray:
        """Return (b,) the group of each boundary face."""
        return self.groups if len(self.groups) else frozen_ints(np.zeros(len(self.faces)))

    def faces_of(self, name: str) -> IntArray:
        """Return the boundary faces of the group called `name`.

        Raises
        ------
        ValueError
            No such group.
        """
        return np.asarray(self.faces[self.group_of_faces() == self.group_names.index(name)])

    def validity(self) -> Validity:
        """Return how well formed the elements are, each certified by the Bézier coefficients of det J."""
        if not len(self.elements):
            return Validity(0.0, (), np.empty((0, 3)))
        bounds = jacobian_bounds(self.nodes[self.elements])
        turned = np.flatnonzero(bounds.low <= 0.0)
        centres = self.nodes[self.elements[turned, :4]].mean(axis=1)
        return Validity(float(bounds.low.min()), tuple(int(k) for k in turned), centres)


@dataclass(frozen=True, slots=True, eq=False)
class Validity:
    """How well formed the elements of a mesh are."""

    min_scaled_jacobian: float
    """Smallest scaled det J anywhere in any element, a lower bound; 1 for a regular straight tetrahedron."""
    turned: tuple[int, ...]
    """Elements that are turned over somewhere, or not certainly not."""
    where: FloatArray
    """(k, 3) mm: the middles of those"""

    @property
    def inverted(self) -> int:
        """How many elements are turned over."""
        return len(self.turned)


def mesh_entry(mesh: TetMesh) -> Mapping[str, int | float]:
    """Return what ``measurement.json`` tells of a mesh (`Measurement.mesh`)."""
    validity = mesh.validity()
    return {
        "order": mesh.order,
        "elements": len(mesh.elements),
        "nodes": len(mesh.nodes),
        "min_scaled_jacobian": validity.min_scaled_jacobian,
        "inverted": validity.inverted,
    }
