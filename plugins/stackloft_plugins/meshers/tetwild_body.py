"""What tetwild is given: a body, its exact figures, and what its surface is made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.closed_mesh import mesh_integrals
from stackloft.geometry.patch_integrals import solid_integrals
from stackloft.model.arrays import FloatArray
from stackloft.model.lofted_solid import LoftedSolid, ShellEnd
from stackloft.model.lofted_solid_check import check_lofted_solid
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.meshers.tetwild_call import check_body


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """What is to be filled."""

    given: LoftedSolid | TriMesh
    patches: FloatArray | None
    """(k, 4, 4, 3) mm, of a loft"""
    figures: tuple[float, float]
    """mm³, mm²: exact"""
    diagonal: float
    """mm"""

    def ends(self) -> tuple[tuple[FloatArray, FloatArray], ...]:
        """Return point and normal of each plane that closes a shell."""
        if isinstance(self.given, TriMesh):
            return ()
        affine = self.given.affine
        normal = np.linalg.inv(affine[:3, :3])[2]
        normal /= np.linalg.norm(normal)
        rims = [
            rim
            for shell in self.given.shells
            for end, rim in zip(
                shell.ends, (shell.patches[0, 0, 0, 0], shell.patches[-1, 0, 3, 0]), strict=True
            )
            if end in {ShellEnd.FACE, ShellEnd.OPENING}
        ]
        return tuple((affine[:3, :3] @ rim + affine[:3, 3], normal) for rim in rims)

    def surface(self, epsilon: float) -> TriMesh:
        """Return the body's surface as triangles within `epsilon`, mm."""
        return self.given if isinstance(self.given, TriMesh) else self.given.tessellate(epsilon)


def body_of(solid: LoftedSolid | TriMesh) -> Body:
    """Return what is to be filled.

    Raises
    ------
    InputError
        A surface that is open, flat, inside out or not finite.
    """
    if isinstance(solid, TriMesh):
        check_body(solid)
        box = np.ptp(solid.vertices[solid.faces.ravel()], axis=0)
        return Body(solid, None, mesh_integrals(solid.vertices, solid.faces), float(np.linalg.norm(box)))
    check_lofted_solid(solid)
    own = np.concatenate([shell.patches.reshape(-1, 4, 4, 3) for shell in solid.shells])
    patches = np.asarray(own @ solid.affine[:3, :3].T + solid.affine[:3, 3])
    parts = np.array([solid_integrals(s.patches, s.face_signs, solid.affine) for s in solid.shells])
    volume, area = (float(total) for total in parts.sum(axis=0))
    return Body(solid, patches, (volume, area), float(np.linalg.norm(np.ptp(patches.reshape(-1, 3), axis=0))))
