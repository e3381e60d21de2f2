"""Sweep: a triangulated section carried through a loft, on the exact surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.geometry.sharp_lines import sharp_columns, sharp_rows
from stackloft.geometry.sweep_plan import SweepPlan, plan_by_count, plan_by_size
from stackloft.geometry.swept_nodes import swept_nodes
from stackloft.geometry.swept_tube import swept_tube
from stackloft.geometry.tet_integrals import elements_volume, exact_volume_degree, faces_area
from stackloft.geometry.tube_stations import tube_lengths
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.errors import InputError
from stackloft.model.guessed_ends import guess_biases
from stackloft.model.lengths import parse_length
from stackloft.model.lofted_solid import LoftedSolid, ShellEnd
from stackloft.model.lofted_solid_check import check_lofted_solid
from stackloft.model.tet_mesh import FIRST_FACE, LAST_FACE, SIDE, TetMesh
from stackloft.model.tet_mesh_check import where

_OTHERWISE = "--method fem-tetwild takes any closed solid"


@dataclass(frozen=True)
class Sweep:
    """Structured tetrahedra: a disc of triangles carried through the sections of a loft, prisms cut in three.

    Boundary nodes lie on the lofted patches to rounding, element edges on its rims, corner lines and knot
    lines (all of them, or every second, third … where the loft is finer than the mesh); at least two rings of
    elements surround a pole; elements are fine at the surface and coarse inside. Carries a single shell
    between two ends, each a pole or a plane face; refuses others. Errs by h⁴ at order 2 and less at
    order 3, by h² at order 1.
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
            The solid is empty or open, has several shells, or its sections change so much that the elements
            would turn over: how many, and where.
        """
        patches, poles = _tube(solid)
        plan = self._plan(patches, poles)
        tube = swept_tube(patches, plan.rows, plan.columns, poles, self.growth)
        if tube is None:
            raise InputError(
                "the section cannot be filled with triangles", where="mesher sweep", fix=_OTHERWISE
            )
        found = swept_nodes(patches, tube, self.order, (not poles[0], not poles[1]))
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
                fix=_OTHERWISE,
            )
        volume = elements_volume(found.nodes, found.elements, exact_volume_degree(self.order))
        volume_bias, area_bias = guess_biases(solid.ends, volume, faces_area(found.nodes, found.faces, 4))
        return replace(mesh, volume_bias=volume_bias, area_bias=area_bias)

    def _plan(self, patches: FloatArray, poles: tuple[bool, bool]) -> SweepPlan:
        lengths = tube_lengths(patches)
        sharp = (sharp_rows(patches), sharp_columns(patches))
        if self.max_element_size is None:
            return plan_by_count(lengths, sharp, poles, self.growth, self.elements)
        return plan_by_size(lengths, sharp, poles, parse_length(self.max_element_size, "max_element_size"))


def _tube(solid: LoftedSolid) -> tuple[FloatArray, tuple[bool, bool]]:
    """Return the only tube of a solid in bench millimetres, and at which ends it has a pole."""
    check_lofted_solid(solid)
    if len(solid.shells) != 1:
        raise InputError(
            "a body with several shells (holes, cavities, branches) cannot be swept",
            where="mesher sweep",
            found=f"{len(solid.shells)} shells",
            expected="one",
            fix=_OTHERWISE,
        )
    shell = solid.shells[0]
    for end in shell.ends:
        if end not in {ShellEnd.POLE, ShellEnd.FACE}:
            raise InputError(
                "a body that branches or closes over a ridge cannot be swept",
                where="mesher sweep",
                found=f"an end of the kind {end.value}",
                expected="poles and plane faces",
                fix=_OTHERWISE,
            )
    patches = np.asarray(shell.patches @ solid.affine[:3, :3].T + solid.affine[:3, 3])
    return patches, (shell.ends[0] is ShellEnd.POLE, shell.ends[1] is ShellEnd.POLE)
