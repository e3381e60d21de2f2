"""Polyhedral: a triangle surface taken at its word, by signed sums."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from stackloft.geometry.closed_mesh import mesh_integrals
from stackloft.model.errors import InputError
from stackloft.model.measurement import Integral
from stackloft.model.notices import Notice
from stackloft.model.tri_mesh import TriMesh
from stackloft.model.tri_mesh_check import check_closed


@dataclass(frozen=True)
class Polyhedral:
    """Volume and area inside a closed, oriented triangle surface, exact but for rounding.

    Signed tetrahedra (Lien & Kajiya 1984). What is measured is the triangles: inscribed ones err low on a
    convex body, by h²/(8·R²) where sides are h long on a radius R, and those of a label map err high in area.
    A surface with a hole in it, or with triangles that disagree which side is out, has no volume and is
    refused. Inner surfaces count as cavities when they are oriented into the body's hollow.

    Examples
    --------
    >>> import numpy as np
    >>> faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    >>> corner = TriMesh(np.vstack([np.zeros(3), np.eye(3)]), faces)
    >>> round(6 * Polyhedral().integrate(corner).volume, 12)
    1.0
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TriMesh,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

    def integrate(self, product: TriMesh) -> Integral:
        """Return volume, mm³, and area, mm²; a notice when the surface is known to be biased.

        Raises
        ------
        InputError
            No triangle; an open surface; triangles oriented differently; a surface inside out.
        """
        check_closed(product)
        volume, area = mesh_integrals(product.vertices, product.faces)
        if volume <= 0.0:
            raise InputError("the surface is inside out, or flat", found=f"volume {volume:g} mm³")
        notices = (Notice("area-biased", product.biased),) if product.biased else ()
        return Integral(volume, area, notices, volume_bias=product.volume_bias, area_bias=product.area_bias)
