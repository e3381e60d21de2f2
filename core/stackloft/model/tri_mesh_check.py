"""Whether a triangle surface encloses a body: well-formed, closed, oriented."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.closed_mesh import edge_faults
from stackloft.model.arrays import IntArray
from stackloft.model.errors import InputError
from stackloft.model.tri_mesh import TriMesh

REPAIR = "mend it: --method repair, or stackloft plugins show reconstructor.repair"


def check_triangles(mesh: TriMesh) -> None:
    """Raise InputError unless `mesh` has triangles of finite vertices that exist.

    Raises
    ------
    InputError
        No vertex, no triangle, arrays of another shape, a vertex that is not finite or does not exist.
    """
    vertices, faces = mesh.vertices, mesh.faces
    if vertices.ndim != 2 or vertices.shape[1:] != (3,):
        raise InputError("not a list of points", found=f"shape {vertices.shape}", expected="(n, 3)")
    if not len(faces):
        raise InputError("the surface has no triangle")
    if faces.ndim != 2 or faces.shape[1:] != (3,):
        raise InputError("not a list of triangles", found=f"shape {faces.shape}", expected="(t, 3)")
    if not len(vertices):
        raise InputError("the surface has no point")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise InputError(
            "a triangle names a vertex that does not exist",
            found=f"{faces.min()} to {faces.max()}",
            expected=f"0 to {len(vertices) - 1}",
        )
    if not np.isfinite(vertices[np.unique(faces)]).all():
        bad = int(np.count_nonzero(~np.isfinite(vertices).all(axis=1)))
        raise InputError("the surface has points that are not finite", found=f"{bad} of {len(vertices)}")


def check_closed(mesh: TriMesh) -> None:
    """Raise InputError unless every edge of `mesh` is run as often one way as the other.

    Raises
    ------
    InputError
        As `check_triangles`; an open surface; triangles that disagree which side is out; edges of three
        triangles and more that do not pair off. The message says how many, and where the first is.
    """
    check_triangles(mesh)
    faults = edge_faults(mesh.faces)
    if not faults.count:
        return
    kinds = (
        (faults.rims, "belong to one triangle alone"),
        (faults.disagreeing, "have triangles that do not agree on which side is out"),
        (faults.crowded, "belong to three triangles or more"),
    )
    found = ", ".join(f"{len(edges)} edges that {what}" for edges, what in kinds if len(edges))
    first = next(edges[0] for edges, _ in kinds if len(edges))
    raise InputError(
        "the surface is open, or is none" if len(faults.rims) else "the surface is not oriented, or is none",
        found=f"{found}; the first near {_place(mesh, first)}",
        expected="every edge run once in each direction",
        fix=REPAIR,
    )


def _place(mesh: TriMesh, edge: IntArray) -> str:
    x, y, z = mesh.vertices[edge].mean(axis=0)
    return f"({x:.4g}, {y:.4g}, {z:.4g}) mm"
