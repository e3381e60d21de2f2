r"""A solid lofted through sections: shells of bicubic B-spline patches between plane faces or poles.

::

          pole or plane face (end)
            ___
           /   \      v: across sections   (rows of patches)
          |-----|     u: along the loop    (columns of patches, closed)
           \___/
          pole or plane face (end)
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from stackloft.geometry.tessellation import tessellate_tube
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.errors import UsageError
from stackloft.model.measurement import EndReport
from stackloft.model.notices import Notice
from stackloft.model.tri_mesh import TriMesh


@dataclass(frozen=True, slots=True, eq=False)
class Shell:
    """One closed tube of patches with its two ends; outward, so an inner shell is a cavity."""

    patches: FloatArray
    """(rows, columns, 4, 4, 3) mm: Bézier control points [row, column, v, u]; columns close on themselves."""
    plane_ends: tuple[bool, bool]
    """True where the end is a plane face bounded by the rim; False where it is a pole."""


@dataclass(frozen=True, slots=True, eq=False)
class LoftedSolid:
    """A closed B-rep."""

    shells: tuple[Shell, ...]
    ends: tuple[EndReport, ...] = ()
    affine: FloatArray = field(default_factory=lambda: frozen_floats(np.eye(4)))
    """(4, 4) from stack millimetres to bench millimetres."""
    notices: tuple[Notice, ...] = ()

    def tessellate(self, tolerance: float) -> TriMesh:
        """Return a closed outward triangle surface.

        Parameters
        ----------
        tolerance : float
            Largest distance between triangles and solid, mm, positive.

        Returns
        -------
        TriMesh
            In bench millimetres.

        Raises
        ------
        UsageError
            The tolerance is not positive.
        """
        if not tolerance > 0.0:
            raise UsageError("the tolerance must be positive", found=f"{tolerance:g} mm")
        vertices, faces, count = [], [], 0
        for shell in self.shells:
            points, triangles = tessellate_tube(shell.patches, shell.plane_ends, tolerance)
            vertices.append(points)
            faces.append(triangles + count)
            count += len(points)
        placed = np.concatenate(vertices) @ self.affine[:3, :3].T + self.affine[:3, 3]
        joined = np.concatenate(faces)
        if np.linalg.det(self.affine[:3, :3]) < 0.0:
            joined = joined[:, ::-1]
        return TriMesh(frozen_floats(placed), frozen_ints(joined))
