"""The ellipsoid of the kit as tetrahedra of order 2: its triangles joined to its centre, nodes on it."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.raised_tets import raised
from stackloft.geometry.tet_boundary import boundary_faces
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.tet_mesh import FIRST_FACE, SIDE, TetMesh
from stackloft.model.tri_mesh import TriMesh

MIRROR_TET = (0, 2, 1, 3, 6, 5, 4, 7, 9, 8)
MIRROR_TRIANGLE = (0, 2, 1, 5, 4, 3)
"""Nodes of an element of order 2 after two of its vertices have changed places."""


def tet_ellipsoid(surface: TriMesh, centre: FloatArray, axes: FloatArray) -> TetMesh:
    """Return the ellipsoid with `surface` inscribed; its lower half is a boundary group of its own."""
    count = len(surface.vertices)
    corners = np.column_stack([surface.faces, np.full(len(surface.faces), count)])[:, [0, 2, 1, 3]]
    high = raised(corners.astype(np.int64), count + 1, 2)
    nodes = high.straight(np.vstack([surface.vertices, centre]))
    faces = boundary_faces(high.elements)
    outer = np.unique(faces)
    round_ = (nodes[outer] - centre) / axes
    nodes[outer] = centre + axes * round_ / np.linalg.norm(round_, axis=1, keepdims=True)
    lower = nodes[faces].mean(axis=1)[:, 2] < centre[2]
    return TetMesh(
        frozen_floats(nodes),
        frozen_ints(high.elements),
        frozen_ints(faces),
        frozen_ints(lower),
        (SIDE, FIRST_FACE),
    )
