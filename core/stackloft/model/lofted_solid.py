r"""A solid lofted through sections: shells of bicubic B-spline patches, closed at their ends.

::

          pole or plane face (end)
            ___
           /   \      v: across sections   (rows of patches)
          |-----|     u: along the loop    (columns of patches, closed)
           \_+_/
           / | \      joint: where a body splits, the rims of the shells on both sides are
          |  |  |     made of the same edges, in one plane

A through hole is a shell whose ends open in the faces of the shell around it; a cavity is a shell of its
own. Shells are oriented outwards from the solid, hence into holes and cavities.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from stackloft.geometry.joined_tubes import Tube, TubeJoint, tessellate_tubes
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints, read_only
from stackloft.model.errors import UsageError
from stackloft.model.measurement import EndReport
from stackloft.model.notices import Notice
from stackloft.model.tri_mesh import TriMesh


class ShellEnd(Enum):
    """How one end of a shell is closed."""

    POLE = "pole"
    """All columns meet in a point."""
    FACE = "face"
    """A plane face inside the rim."""
    OPENING = "opening"
    """The rim bounds a hole in another shell's face."""
    JOINT = "joint"
    """The surface goes on in other shells."""


@dataclass(frozen=True, slots=True, eq=False)
class Shell:
    """One tube of patches with its two ends; outward from the solid, so a hole's points into it."""

    patches: FloatArray
    """(rows, columns, 4, 4, 3) mm: Bézier control points [row, column, v, u]; columns close on themselves."""
    ends: tuple[ShellEnd, ShellEnd]

    @property
    def plane_ends(self) -> tuple[bool, bool]:
        """Where the end is a plane face of this shell's own."""
        return self.ends[0] is ShellEnd.FACE, self.ends[1] is ShellEnd.FACE

    @property
    def face_signs(self) -> tuple[float | None, float | None]:
        """What each plane end adds to the area: 1 a face, -1 an opening in one, 0 a joint; None: a pole."""
        return _FACE_SIGN[self.ends[0]], _FACE_SIGN[self.ends[1]]


_FACE_SIGN = {ShellEnd.POLE: None, ShellEnd.FACE: 1.0, ShellEnd.OPENING: -1.0, ShellEnd.JOINT: 0.0}


@dataclass(frozen=True, slots=True)
class JointRim:
    """A shell's rim at a joint, as a closed run of the joint's edges."""

    shell: int
    at_last: bool
    edges: tuple[tuple[int, bool], ...]
    """(edge, forward) in order along the rim, in the direction of the shell's u."""


@dataclass(frozen=True, slots=True, eq=False)
class Joint:
    """Where shells meet in a plane: every edge belongs to two rims, once in each direction of the surface."""

    edges: tuple[FloatArray, ...]
    """(k, 3) mm: points along each edge, first and last included"""
    rims: tuple[JointRim, ...]


@dataclass(frozen=True, slots=True, eq=False)
class LoftedSolid:
    """A closed B-rep."""

    shells: tuple[Shell, ...]
    ends: tuple[EndReport, ...] = ()
    affine: FloatArray = field(default_factory=lambda: frozen_floats(np.eye(4)))
    """(4, 4) from stack millimetres to bench millimetres."""
    notices: tuple[Notice, ...] = ()
    joints: tuple[Joint, ...] = ()

    def flipped(self, flip: tuple[float, float]) -> LoftedSolid:
        """Return the solid with x and y multiplied by 1 or -1, where it lay on the bench, and outward again.

        In one mirror the shells' u runs the other way.
        """
        if flip == (1.0, 1.0):
            return self
        scale, mirror = np.array([*flip, 1.0]), flip[0] * flip[1] < 0.0

        def turned(shell: Shell) -> Shell:
            patches = shell.patches * scale
            return Shell(read_only(patches[:, ::-1, :, ::-1] if mirror else patches), shell.ends)

        def rim(one: JointRim) -> JointRim:
            back = tuple((edge, not forward) for edge, forward in reversed(one.edges))
            return JointRim(one.shell, one.at_last, back) if mirror else one

        joints = (
            Joint(tuple(frozen_floats(edge * scale) for edge in joint.edges), tuple(map(rim, joint.rims)))
            for joint in self.joints
        )
        affine = frozen_floats(self.affine * [*flip, 1.0, 1.0])
        return LoftedSolid(tuple(map(turned, self.shells)), self.ends, affine, self.notices, tuple(joints))

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
        tubes = [Tube(shell.patches, shell.face_signs) for shell in self.shells]
        joints = [
            TubeJoint(joint.edges, tuple((rim.shell, rim.at_last, rim.edges) for rim in joint.rims))
            for joint in self.joints
        ]
        vertices, faces = tessellate_tubes(tubes, joints, tolerance)
        placed = vertices @ self.affine[:3, :3].T + self.affine[:3, 3]
        if np.linalg.det(self.affine[:3, :3]) < 0.0:
            faces = faces[:, ::-1]
        return TriMesh(frozen_floats(placed), frozen_ints(faces))
