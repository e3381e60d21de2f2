"""What the surface writers share: a product as triangles, checked before a byte is written."""

from __future__ import annotations

import numpy as np

from stackloft.model.errors import OutputError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tri_mesh import TriMesh

TOLERANCE = 0.02
"""Default distance, mm, between a solid and its triangles: a tenth of a fine photograph's pixel."""


def triangles_of(product: LoftedSolid | TriMesh, tolerance: float) -> TriMesh:
    """Return `product` as triangles; a solid is tessellated to `tolerance` mm.

    Raises
    ------
    OutputError
        No triangle, a vertex that is not finite, or a corner that names no vertex.
    """
    mesh = product.tessellate(tolerance) if isinstance(product, LoftedSolid) else product
    if len(mesh.faces) == 0:
        raise OutputError("the surface has no triangles")
    if not np.isfinite(mesh.vertices).all():
        raise OutputError("the surface has vertices that are not finite")
    if mesh.faces.min() < 0 or mesh.faces.max() >= len(mesh.vertices):
        raise OutputError(
            "a triangle names a vertex that does not exist",
            found=f"{mesh.faces.min()} to {mesh.faces.max()}",
            expected=f"0 to {len(mesh.vertices) - 1}",
        )
    return mesh
