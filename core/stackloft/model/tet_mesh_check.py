"""Whether a tetrahedral mesh can be measured: whole, closed, nowhere turned over."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.closed_mesh import unmatched_edges
from stackloft.geometry.lagrange_simplex import TET_NODES, TRIANGLE_NODES
from stackloft.geometry.tet_boundary import boundary_faces
from stackloft.model.arrays import IntArray
from stackloft.model.errors import InputError
from stackloft.model.tet_mesh import TetMesh, Validity

_SHOWN = 3


def check_tet_mesh(mesh: TetMesh) -> Validity:
    """Return the mesh's validity, or raise InputError.

    Raises
    ------
    InputError
        No elements; arrays that do not fit each other; nodes that are not finite; boundary faces that are
        not those of the elements, or not closed; elements that are turned over (how many, and where).
    """
    _check_arrays(mesh)
    _check_boundary(mesh)
    validity = mesh.validity()
    if validity.inverted:
        raise InputError(
            f"{validity.inverted} of {len(mesh.elements)} elements are turned over",
            found=f"smallest scaled Jacobian {validity.min_scaled_jacobian:.3g}; {where(validity)}",
            expected="a positive Jacobian everywhere",
            fix="use smaller elements, or order 1",
        )
    return validity


def where(validity: Validity) -> str:
    """Return where the first few turned elements lie."""
    places = [f"({x:.4g}, {y:.4g}, {z:.4g})" for x, y, z in validity.where[:_SHOWN]]
    more = ", …" if len(validity.where) > _SHOWN else ""
    return f"at {', '.join(places)}{more} mm"


def _check_arrays(mesh: TetMesh) -> None:
    if mesh.elements.ndim != 2 or mesh.elements.shape[1] not in TET_NODES.values():
        raise InputError("not tetrahedra", found=f"elements of shape {mesh.elements.shape}",
                         expected="(m, 4), (m, 10) or (m, 20)")  # fmt: skip
    if not len(mesh.elements):
        raise InputError("the mesh has no elements")
    wanted = TRIANGLE_NODES[mesh.order]
    if mesh.faces.ndim != 2 or mesh.faces.shape[1] != wanted:
        raise InputError("the boundary faces do not fit the elements", found=str(mesh.faces.shape),
                         expected=f"(b, {wanted})")  # fmt: skip
    if mesh.nodes.ndim != 2 or mesh.nodes.shape[1] != 3 or not np.isfinite(mesh.nodes).all():
        raise InputError("the mesh has nodes that are not finite points", found=str(mesh.nodes.shape))
    for name, index in (("element", mesh.elements), ("face", mesh.faces)):
        if index.size and not 0 <= index.min() <= index.max() < len(mesh.nodes):
            raise InputError(f"an {name} names a node that does not exist" if name == "element"
                             else "a face names a node that does not exist",
                             found=f"{index.min()} to {index.max()}",
                             expected=f"0 to {len(mesh.nodes) - 1}")  # fmt: skip
    groups = mesh.group_of_faces()
    if groups.shape != (len(mesh.faces),):
        raise InputError("not one group per boundary face", found=str(groups.shape))
    if groups.size and not 0 <= groups.min() <= groups.max() < len(mesh.group_names):
        raise InputError("a boundary face's group has no name", found=str(int(groups.max())))


def _check_boundary(mesh: TetMesh) -> None:
    try:
        own = boundary_faces(mesh.elements)
    except ValueError as error:
        raise InputError("the elements overlap", found=str(error)) from error
    if not np.array_equal(_sorted(own), _sorted(mesh.faces)):
        raise InputError(
            "the boundary faces are not those of the elements",
            found=f"{len(mesh.faces)} faces, of which {_shared(own, mesh.faces)} are the elements'",
            expected=f"{len(own)}",
        )
    if unmatched_edges(mesh.faces[:, :3]):
        raise InputError("the mesh's boundary is open", found=f"{unmatched_edges(mesh.faces[:, :3])} edges")


def _sorted(faces: IntArray) -> IntArray:
    """Return the oriented vertex triples of faces, each from its lowest vertex, in order."""
    start = np.argmin(faces[:, :3], axis=1)
    turned = np.take_along_axis(faces[:, :3], (start[:, None] + np.arange(3)) % 3, axis=1)
    return np.asarray(turned[np.lexsort(turned.T[::-1])])


def _shared(one: IntArray, other: IntArray) -> int:
    rows = {tuple(row) for row in _sorted(one).tolist()}
    return sum(tuple(row) in rows for row in _sorted(other).tolist())
