"""What the writers of tetrahedra share: a mesh that is checked before a byte is written."""

from __future__ import annotations

from stackloft.model.errors import InputError, OutputError
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tet_mesh_check import check_tet_mesh


def checked(mesh: TetMesh, form: str, highest: int = 2) -> TetMesh:
    """Return `mesh`, whole and of an order that the format has.

    Raises
    ------
    OutputError
        No elements, nodes that are not finite, elements that are turned over, an order that is too high.
    """
    try:
        check_tet_mesh(mesh)
    except InputError as error:
        raise OutputError(
            f"the mesh cannot be written: {error.what}", where=form, found=error.found
        ) from error
    if mesh.order > highest:
        raise OutputError(
            "the format has no elements of this order",
            where=form,
            found=f"order {mesh.order}",
            expected=f"order {highest} or less",
            fix="give --order 2, or write .vtu",
        )
    return mesh
