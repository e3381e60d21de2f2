"""Cavalieri: volume as the integral of section areas."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError
from stackloft.model.measurement import Integral
from stackloft.sectioning.section_measures import section_areas


@dataclass(frozen=True)
class Cavalieri:
    """Sum of area × slice thickness; no area.

    ``rectangle`` gives every section the slab half-way to its neighbours (the first and last as much
    outwards as inwards): right when the body was cut into slices and each is measured somewhere in its
    own slice; on an ellipsoid with m sections at mid-thickness it errs by +1/(2m²).
    ``trapezoid`` integrates the straight lines between areas from the first to the last section and
    nothing beyond: right when these are the end faces, low otherwise. Cavalieri (1635); Gundersen &
    Jensen (1987), J. Microscopy 147:229.
    """

    rule: str = option("rectangle", "how areas are joined along the axis", choices=("rectangle", "trapezoid"))

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (ContourStack,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

    def integrate(self, product: ContourStack) -> Integral:
        """Return the volume, mm³; the area is None.

        Raises
        ------
        InputError
            Fewer than two sections, or no area at all.
        """
        z = product.positions
        if len(z) < 2:
            raise InputError("Cavalieri needs at least 2 sections", found=str(len(z)))
        areas = section_areas(product)
        if not areas.sum() > 0.0:
            raise InputError("the sections have no area")
        jacobian = abs(float(np.linalg.det(product.affine[:3, :3])))
        return Integral(jacobian * float(self._weights(z) @ areas), None)

    def _weights(self, z: FloatArray) -> FloatArray:
        """Return each section's length along the axis, mm."""
        gaps = np.diff(z)
        weights = np.zeros(len(z))
        weights[:-1] += 0.5 * gaps
        weights[1:] += 0.5 * gaps
        if self.rule == "rectangle":
            weights[0] += 0.5 * gaps[0]
            weights[-1] += 0.5 * gaps[-1]
        return weights
