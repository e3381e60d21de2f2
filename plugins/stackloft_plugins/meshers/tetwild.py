"""Tetwild: tetrahedra in any closed surface by fTetWild, their boundary put on the exact one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.geometry.bisected_tets import bisected, edges_in_the_way
from stackloft.geometry.raised_tets import raised
from stackloft.geometry.tet_boundary import boundary_faces
from stackloft.geometry.tet_integrals import elements_volume, faces_area
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, frozen_ints
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.notices import Notice
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tet_mesh_check import where
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.meshers.boundary_groups import boundary_groups
from stackloft_plugins.meshers.boundary_target import BoundaryTarget, boundary_target
from stackloft_plugins.meshers.settling import settled
from stackloft_plugins.meshers.sizing_field import sizing_field
from stackloft_plugins.meshers.snapping import corners_taken, regions_of_faces, snapped
from stackloft_plugins.meshers.tetwild_body import Body, body_of
from stackloft_plugins.meshers.tetwild_call import WHERE, Wanted, check_body, tetrahedra
from stackloft_plugins.worker import Limits

_EPSILON = 2e-3
"""Envelope as a part of the box's diagonal, when none is given: fTetWild's default is half of it."""
_SHARE = 0.05
"""Envelope as a part of V/S at most: of a plate's half thickness."""
_CROWD = 1.5
"""Elements that fTetWild makes for each that regular tetrahedra of the wanted size would need."""
_FINER = (1.0, 0.6, 0.3)
"""Envelopes tried one after the other when the boundary cannot be fitted, as parts of the first."""
_EXACT = 1e-9
"""Relative difference allowed where every region is plane: rounding."""
_REGULAR = 0.118
_CUTS = 4
"""Most times that edges which keep faces from bending are cut."""


@dataclass(frozen=True)
class Tetwild:
    """Tetrahedra in any closed surface (Hu et al. 2020, fTetWild), their boundary moved to where it belongs.

    fTetWild's boundary lies within `epsilon` of the surface, on the whole inside of it: linear elements taken
    as they come are low in volume by about three times its share of the diagonal. Here every boundary node is
    put on the exact surface, on its sharp edges and corners, before anything is measured; curved elements
    follow it between. fTetWild has no seed, so that no two meshes are the same; how far a mesh is off its own
    surface is known, and travels with it as its uncertainty. It runs in a process of its own.
    """

    order: int = option(2, "polynomial degree of the elements: 1, 2 or 3", ge=1, le=3)
    elements: int = option(6000, "about so many elements, when no max_element_size is given", ge=50)
    max_element_size: float | None = option(None, "wanted edge length where nothing bends", unit="mm", gt=0)
    curvature_factor: float | None = option(
        None, "elements per radius of curvature; where the surface bends they become smaller", gt=0
    )
    epsilon: float | None = option(
        None,
        "how far fTetWild's boundary may be from the surface; 0.002 of the diagonal or less",
        unit="mm",
        gt=0,
    )
    quality: float = option(
        10.0, "energy of the worst element at which it stops; 3: regular", gt=3, source="Hu et al. (2020)"
    )
    time_limit: float = option(600.0, "longest time for one mesh", unit="s", gt=0)
    memory_limit: float = option(4000.0, "most memory for one mesh", unit="MB", gt=0)

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (LoftedSolid, TriMesh)
    produces: ClassVar[tuple[type, ...]] = (TetMesh,)

    def mesh(self, solid: LoftedSolid | TriMesh) -> TetMesh:
        """Return the tetrahedra, in bench millimetres.

        Raises
        ------
        InputError
            A surface that is open, flat, inside out or not finite; an envelope that is too thin; pytetwild
            crashed, took too long or too much memory; elements that stay turned over.
        """
        body = body_of(solid)
        wanted = self._wanted(body)
        surface = body.surface(wanted.epsilon)
        check_body(surface)
        target = boundary_target(surface, body.patches, body.ends())
        faults = []
        for part in _FINER:
            try:
                return self._fitted(target, body, replace(wanted, epsilon=part * wanted.epsilon))
            except _UnfitError as fault:
                faults.append(fault)
        best = min(faults, key=lambda fault: fault.off)
        if best.mesh is None:
            raise InputError("the elements cannot be fitted to the surface", where=WHERE, found=str(best),
                             fix="give a smaller max_element_size, or order 1")  # fmt: skip
        return best.mesh

    def _wanted(self, body: Body) -> Wanted:
        diagonal, volume, area = body.diagonal, body.figures[0], body.figures[1]
        size = self.max_element_size
        if size is None:
            size = (volume * _CROWD / (_REGULAR * self.elements)) ** (1.0 / 3.0)
        epsilon = self.epsilon
        if epsilon is None:
            epsilon = min(_EPSILON * diagonal, _SHARE * volume / area)
        return Wanted(float(size), float(epsilon), self.quality, Limits(self.time_limit, self.memory_limit))

    def _fitted(self, target: BoundaryTarget, body: Body, wanted: Wanted) -> TetMesh:
        field = None
        if self.curvature_factor is not None:
            field = sizing_field(target.surface, target.regions, wanted.size, self.curvature_factor)
        nodes, elements = tetrahedra(target.surface, wanted, field)
        return _placed(nodes, elements, target, body, self.order, wanted.epsilon)


class _UnfitError(Exception):
    """A mesh that does not fit its surface; `mesh` when it may be used all the same."""

    def __init__(self, words: str, off: float, mesh: TetMesh | None = None) -> None:
        self.off = off
        self.mesh = mesh
        super().__init__(words)


def _placed(
    nodes: FloatArray, elements: IntArray, target: BoundaryTarget, body: Body, order: int, reach: float
) -> TetMesh:
    """Return the mesh with its boundary on the target, at `order`."""
    try:
        return _on_target(nodes, elements, target, body, order, reach)
    except (
        ValueError,
        RuntimeError,
        np.linalg.LinAlgError,
    ) as error:  # faces of three elements, flat elements
        raise _UnfitError(str(error), np.inf) from error


def _on_target(
    nodes: FloatArray, elements: IntArray, target: BoundaryTarget, body: Body, order: int, reach: float
) -> TetMesh:
    for _ in range(_CUTS):
        flat = boundary_faces(elements)
        regions = regions_of_faces(nodes, flat, target, 2.0 * reach)
        cut = edges_in_the_way(nodes, elements, flat, regions)
        if not len(cut):
            break
        nodes, elements = bisected(nodes, elements, cut)
    flat = boundary_faces(elements)
    regions = regions_of_faces(nodes, flat, target, 2.0 * reach)
    rim = np.unique(flat)
    held = np.zeros(len(nodes), dtype=bool)
    held[rim] = True
    corners = corners_taken(snapped(nodes, flat, regions, target, rim), rim, target)
    vertices = settled(nodes, corners, elements, held)
    high = raised(elements, len(nodes), order)
    straight = high.straight(vertices)
    faces = boundary_faces(high.elements)
    outer = np.unique(faces)
    curved = snapped(straight, faces, regions, target, outer[outer >= len(nodes)])
    held = np.zeros(len(straight), dtype=bool)
    held[outer] = True
    final = settled(straight, curved, high.elements, held)
    return _judged(final, high.elements, faces, regions, target, body)


def _judged(
    nodes: FloatArray,
    elements: IntArray,
    faces: IntArray,
    regions: IntArray,
    target: BoundaryTarget,
    body: Body,
) -> TetMesh:
    """Return the mesh with how far it is off; raise when elements turn over or plane faces are not met."""
    groups, names = boundary_groups(regions, target, body.given)
    figures = elements_volume(nodes, elements, 6), faces_area(nodes, faces, 10)
    off = [abs(found - exact) for found, exact in zip(figures, body.figures, strict=True)]
    mesh = TetMesh(
        frozen_floats(nodes),
        frozen_ints(elements),
        frozen_ints(faces),
        frozen_ints(groups),
        names,
        volume_uncertainty=off[0],
        area_uncertainty=off[1],
    )
    validity = mesh.validity()
    if validity.inverted:
        words = f"{validity.inverted} of {len(elements)} elements are turned over, {where(validity)}"
        raise _UnfitError(words, np.inf)
    worst = max(off[0] / body.figures[0], off[1] / body.figures[1])
    if target.regions.plane.all() and worst > _EXACT:
        told = Notice(
            "edges-not-met",
            f"the mesh misses sharp edges: volume and area are off by up to {100 * worst:.2g} %"
            " (--set mesher.tetwild.max_element_size=… smaller)",
        )
        raise _UnfitError("sharp edges are not met", worst, replace(mesh, notices=(told,)))
    return mesh
