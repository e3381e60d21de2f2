"""Frustums: the body as conical slices between sections (Sabliov et al. 2002; Zheng & Sun 2006)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.optimize import linear_sum_assignment

from stackloft.model.arrays import BoolArray, FloatArray
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError
from stackloft.model.measurement import Integral
from stackloft.sectioning.section_measures import LoopMeasures, measure_loops, section_areas


@dataclass(frozen=True)
class Frustum:
    """Frustums between neighbouring sections, plane faces on the first and last.

    Sabliov, Boldor, Keener & Farkas (2002), Int. J. Food Properties 5:641; Zheng & Sun (2006), Food
    Engineering: each slice is a frustum of a cone with the sections' areas A and mean radii P/2π,
    V = h·(A₁ + A₂ + √(A₁A₂))/3, side = (P₁ + P₂)/2 · √(h² + (P₁ − P₂)²/4π²). Both volume and area stop
    at the outermost sections, so they err low on bodies with round ends, and the side is exact only for
    coaxial similar sections. Several outlines, and holes, have frustums of their own, each with the nearest
    of the next section; where their number changes from one section to the next, sides are taken as upright.
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (ContourStack,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

    def integrate(self, product: ContourStack) -> Integral:
        """Return volume, mm³, and area, mm², between the first and the last section.

        Raises
        ------
        InputError
            Fewer than two sections, no area, or sheared slices (the mean radius means nothing there).
        """
        z = product.positions
        if len(z) < 2:
            raise InputError("frustums need at least 2 sections", found=str(len(z)))
        if not np.allclose(product.affine[:3, :3] @ product.affine[:3, :3].T, np.eye(3), atol=1e-9):
            raise InputError("frustums need unsheared sections", fix="use --method loft")
        areas = section_areas(product)
        if not areas.sum() > 0.0:
            raise InputError("the sections have no area")
        height = np.diff(z)
        a, b = areas[:-1], areas[1:]
        volume = float((height * (a + b + np.sqrt(a * b))).sum() / 3.0)
        loops = measure_loops(product)
        sides = sum(_sides(height, loops, loops.sign == sign) for sign in (1.0, -1.0))
        return Integral(volume, sides + float(areas[0] + areas[-1]))


def _sides(height: FloatArray, loops: LoopMeasures, own: BoolArray) -> float:
    """Return the sides' area of frustums between the loops of one kind, outlines or holes."""
    total = 0.0
    for k, h in enumerate(height):
        below, above = (np.flatnonzero(own & (loops.section == section)) for section in (k, k + 1))
        p, q = loops.perimeters[below], loops.perimeters[above]
        if len(below) != len(above):
            total += 0.5 * h * float(p.sum() + q.sum())
            continue
        apart = np.linalg.norm(loops.centroids[below, None] - loops.centroids[above], axis=2)
        i, j = linear_sum_assignment(apart)
        total += 0.5 * float(((p[i] + q[j]) * np.hypot(h, (p[i] - q[j]) / (2.0 * np.pi))).sum())
    return total
