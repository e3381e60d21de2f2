"""One reconstructor, what the kit may ask of it, and the figures of what it makes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from stackloft.geometry.closed_mesh import mesh_integrals
from stackloft.model.arrays import FloatArray
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tri_mesh import TriMesh
from stackloft.registry.options_model import validate
from stackloft.testing.conformance import ellipsoids
from stackloft.testing.conformance.check import must


@dataclass(frozen=True, slots=True)
class ReconstructorCase:
    """One reconstructor and what may be asked of it."""

    reconstructor: type[Any]
    options: Mapping[str, Any] = field(default_factory=dict)
    steadiness: float = 1e-3
    """Relative change of volume and area allowed where nothing should change."""
    volume_tolerance: float = 0.03
    """Relative error allowed at the finest resolution."""
    area_tolerance: float = 0.06
    settled: float = 0.01
    """Relative error below which a finer body need not do better."""
    place_tolerance: float = 0.1
    """mm by which the body's centre may be off; its axes are 14, 8, 8 mm."""

    def reconstruct(self, product: Any) -> Any:
        """Return the solid or surface."""
        values = validate(self.reconstructor, self.options, self.reconstructor.__name__)
        return self.reconstructor(**values).reconstruct(product)

    def figures(self, product: Any) -> tuple[float, float, FloatArray]:
        """Return volume, area and centre of what is made of `product`."""
        return figures_of(self.reconstruct(product))

    def bodies(self, fineness: int = 1) -> list[Any]:
        """Return the ellipsoid as each product type that is accepted and that the kit can make."""
        fitting = [make for kind, make in ellipsoids.MAKERS.items() if kind in self.reconstructor.accepts]
        must(fitting, f"the kit has no body of a type in {self.reconstructor.accepts}")
        return [make(fineness) for make in fitting]


def mesh_of(solid: Any) -> TriMesh:
    """Return a solid or surface as triangles in bench millimetres."""
    known = isinstance(solid, (LoftedSolid, TriMesh))
    must(known, f"{type(solid).__name__} is returned, not a LoftedSolid or TriMesh")
    if isinstance(solid, TriMesh):
        return solid
    sizes = [np.ptp(shell.patches, axis=(0, 1, 2, 3)).max() for shell in solid.shells]
    mesh: TriMesh = solid.tessellate(5e-4 * float(min(sizes)))
    return mesh


def figures_of(solid: Any) -> tuple[float, float, FloatArray]:
    """Return volume, area and the volume's centre of a closed solid or surface."""
    mesh = mesh_of(solid)
    volume, area = mesh_integrals(mesh.vertices, mesh.faces)
    middle = mesh.vertices.mean(axis=0)
    a, b, c = (mesh.vertices[mesh.faces[:, k]] - middle for k in range(3))
    parts = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    centre = middle + ((a + b + c) / 4.0 * parts[:, None]).sum(axis=0) / parts.sum()
    return volume, area, np.asarray(centre)
