"""Surface Gauss: the lofted surface itself, integrated by the divergence theorem."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from stackloft.geometry.patch_integrals import solid_integrals
from stackloft.model.errors import InputError
from stackloft.model.guessed_ends import guess_biases
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.lofted_solid_check import check_lofted_solid
from stackloft.model.measurement import Integral


@dataclass(frozen=True)
class SurfaceGauss:
    """Gauss quadrature per patch of ⅓∮P·dA and ∮dA over the exact lofted surface.

    Exact in volume for the bicubic surface, converging in area; no mesh, so no meshing error.
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (LoftedSolid,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

    def integrate(self, product: LoftedSolid) -> Integral:
        """Return volume and area of all shells.

        Raises
        ------
        InputError
            The solid has no shell, is open, or is inside out.
        """
        check_lofted_solid(product)
        parts = [solid_integrals(s.patches, s.face_signs, product.affine) for s in product.shells]
        volume = sum(part[0] for part in parts)
        if volume <= 0.0:
            raise InputError("the lofted surface is inside out", found=f"volume {volume:g} mm³")
        area = sum(part[1] for part in parts)
        volume_bias, area_bias = guess_biases(product.ends, volume, area)
        return Integral(volume, area, volume_bias=volume_bias, area_bias=area_bias)
