"""Sweep: a triangulated section carried through a loft, on the exact surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.geometry.sharp_lines import sharp_columns, sharp_rows
from stackloft.geometry.sweep_plan import SweepLines, SweepPlan, plan_by_count, plan_by_size
from stackloft.geometry.swept_nodes import swept_nodes
from stackloft.geometry.swept_tube import swept_tube
from stackloft.geometry.tet_integrals import elements_volume, exact_volume_degree, faces_area
from stackloft.geometry.tube_stations import tube_lengths
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.errors import InputError
from stackloft.model.guessed_ends import guess_biases
from stackloft.model.lengths import parse_length
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tet_mesh import FIRST_FACE, LAST_FACE, SIDE, TetMesh
from stackloft.model.tet_mesh_check import where
from stackloft_plugins.meshers.swept_shells import OTHERWISE, swept_tubes, wall


@dataclass(frozen=True)
class Sweep:
    """Structured tetrahedra: a disc or ring of triangles carried through a loft, its prisms cut in three.

    Boundary nodes lie on the lofted patches to rounding, element edges on its rims, corner lines and knot
    lines (all of them, or every second, third … where the loft is finer than the mesh); at least two rings of
    elements surround a pole; elements are fine at the surface and coarse inside. Carries a single shell
    between two ends, each a pole or a plane face, and one with a hole from face to face; refuses others.
    Errs by h⁴ at order 2 and less at order 3, by h² at order 1.
    """

    order: int = option(2, "polynomial degree of the elements: 1, 2 or 3", ge=1, le=3)
    elements: int = option(5000, "at most so many elements, when no max_element_size is given", ge=100)
    max_element_size: float | None = option(None, "longest element edge on the surface", unit="mm", gt=0)
    growth: float = option(3.0, "edges become so much longer from ring to ring inwards", ge=1, le=4)

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (LoftedSolid,)
    produces: ClassVar[tuple[type, ...]] = (TetMesh,)

    def mesh(self, solid: LoftedSolid) -> TetMesh:
        """Return the tetrahedra, in bench millimetres.

        Raises
        ------
        InputError
            The solid is empty or open, has a cavity, branches or several holes, or its sections change so
            much that the elements would turn over: how many, and where.
        """
        tubes, poles = swept_tubes(solid)
        plan = self._plan(tubes, poles)
        tube = swept_tube(tubes, plan.rows, plan.columns, poles, self.growth)
        if tube is None:
            raise InputError(
                "the section cannot be filled with triangles", where="mesher sweep", fix=OTHERWISE
            )
        found = swept_nodes(tubes, tube, self.order, (not poles[0], not poles[1]))
        mesh = TetMesh(
            frozen_floats(found.nodes),
            frozen_ints(found.elements),
            frozen_ints(found.faces),
            frozen_ints(found.ends),
            (SIDE, FIRST_FACE, LAST_FACE),
        )
        validity = mesh.validity()
        if validity.inverted:
            raise InputError(
                "the sections change too much from one to the next to be swept",
                where="mesher sweep",
                found=f"{validity.inverted} of {len(mesh.elements)} elements turned over, {where(validity)}",
                fix=OTHERWISE,
            )
        volume = elements_volume(found.nodes, found.elements, exact_volume_degree(self.order))
        volume_bias, area_bias = guess_biases(solid.ends, volume, faces_area(found.nodes, found.faces, 4))
        return replace(mesh, volume_bias=volume_bias, area_bias=area_bias)

    def _plan(self, tubes: tuple[FloatArray, ...], poles: tuple[bool, bool]) -> SweepPlan:
        lengths = [tube_lengths(patches) for patches in tubes]
        lines = SweepLines(
            np.max([rows for rows, _ in lengths], axis=0),
            tuple(columns for _, columns in lengths),
            np.any([sharp_rows(patches) for patches in tubes], axis=0),
            tuple(sharp_columns(patches) for patches in tubes),
            poles,
            wall(tubes).max() if len(tubes) == 2 else 0.0,
        )
        if self.max_element_size is None:
            return plan_by_count(lines, self.growth, self.elements)
        return plan_by_size(lines, parse_length(self.max_element_size, "max_element_size"))
