"""Cavalieri: volume as the integral of section areas."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.geometry.systematic_sampling import sampling_precision
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError
from stackloft.model.measurement import Integral
from stackloft.sectioning.section_measures import section_areas
from stackloft.sectioning.slabs import outer_bias, slab_lengths


@dataclass(frozen=True)
class Cavalieri:
    """Sum of area × slice thickness; no area.

    ``rectangle`` gives every section the slab half-way to its neighbours (the first and last as much
    outwards as inwards): right when the body was cut into slices and each is measured somewhere in its
    own slice; on an ellipsoid with m sections at mid-thickness it errs by +1/(2m²).
    ``trapezoid`` integrates the straight lines between areas from the first to the last section and
    nothing beyond: right when these are the end faces, low otherwise. Cavalieri (1635); Gundersen &
    Jensen (1987), J. Microscopy 147:229.

    At equal distances the areas also tell how precise the sum is when the cuts lie at random on the body
    (``coefficient_of_error``, from the estimated ``smoothness`` class q: Kiêu, Souchet & Istas 1999;
    García-Fiñana & Cruz-Orive 2004; `stackloft.geometry.systematic_sampling`).
    Cuts at mid-thickness of a body that is divided evenly are not at random: their error is the +1/(2m²).
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
        amounts = areas * slab_lengths(z)
        outer = outer_bias(amounts)
        if self.rule == "trapezoid":
            amounts[[0, -1]] *= 0.5
            outer = replace(outer, low=2.0 * outer.low, high=0.5)
        volume = abs(float(np.linalg.det(product.affine[:3, :3]))) * float(amounts.sum())
        precision = sampling_precision(areas) if _evenly(z) else None
        if precision is None:
            return Integral(volume, None, volume_bias=outer)
        return Integral(
            volume,
            None,
            volume_uncertainty=precision.coefficient_of_error * volume,
            volume_bias=outer,
            details={
                "coefficient_of_error": precision.coefficient_of_error,
                "smoothness": precision.smoothness,
            },
        )


def _evenly(z: FloatArray) -> bool:
    gaps = np.diff(z)
    return bool(np.ptp(gaps) <= 1e-3 * gaps.mean())
