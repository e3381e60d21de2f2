"""Abaqus and CalculiX INP: C3D4 or C3D10, boundary groups as surfaces and node sets; millimetres.

The nodes of C3D10 come in the order of this project: vertices, then the edges 12, 23, 31, 14, 24, 34. Element
faces are S1 = 123, S2 = 142, S3 = 243, S4 = 341 (CalculiX CrunchiX user's manual, §6.2; Abaqus Elements
Guide).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import BinaryIO, ClassVar

import numpy as np

from stackloft.geometry.lagrange_simplex import OUTWARD_FACES
from stackloft.model.arrays import IntArray
from stackloft.model.tet_mesh import BODY, TetMesh
from stackloft_plugins.writers.rows import rows
from stackloft_plugins.writers.tets import checked

_TYPE = {1: "C3D4", 2: "C3D10"}
_SIDES = ({0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0})
"""Vertices of S1 to S4."""
_SIDE = (
    np.array([next(k for k, side in enumerate(_SIDES) if side == set(face)) for face in OUTWARD_FACES]) + 1
)
"""Number of the side that each outward face is."""
_PER_LINE = 10


@dataclass(frozen=True)
class InpWriter:
    """Writes tetrahedra of order 1 or 2 for Abaqus and CalculiX: the mesh and its sets, no analysis."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TetMesh,)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".inp",)

    def write(self, product: TetMesh, stream: BinaryIO) -> None:
        """Write `product` to `stream`.

        Raises
        ------
        OutputError
            The mesh is not whole, or of order 3.
        """
        mesh = checked(product, "writer inp")
        body = BODY.upper()
        parts = [
            "*HEADING\nstackloft, unit mm\n",
            f"*NODE, NSET=NALL\n{rows(mesh.nodes, joint=', ', first=1)}",
            f"*ELEMENT, TYPE={_TYPE[mesh.order]}, ELSET={body}\n",
            rows(mesh.elements + 1, joint=", ", first=1),
        ]
        owner, side = _owners(mesh)
        groups = mesh.group_of_faces()
        for k in np.unique(groups):
            name, mine = mesh.group_names[k].upper().replace("-", "_"), groups == k
            parts.append(f"*NSET, NSET={name}\n{_listed(np.unique(mesh.faces[mine]) + 1)}")
            faces = zip((owner[mine] + 1).tolist(), side[mine].tolist(), strict=True)
            parts.append(f"*SURFACE, NAME=S_{name}, TYPE=ELEMENT\n")
            parts += [f"{element}, S{number}\n" for element, number in faces]
        stream.write("".join(parts).encode("utf-8"))


def _owners(mesh: TetMesh) -> tuple[IntArray, IntArray]:
    """Return the element that each boundary face belongs to, and which of its sides S1 to S4 it is."""
    corners = np.sort(mesh.elements[:, np.array(OUTWARD_FACES)], axis=2).reshape(-1, 3)
    wanted = np.sort(mesh.faces[:, :3], axis=1)
    span = len(mesh.nodes)
    key = (corners[:, 0] * span + corners[:, 1]) * span + corners[:, 2]
    asked = (wanted[:, 0] * span + wanted[:, 1]) * span + wanted[:, 2]
    order = np.argsort(key)
    place = order[np.searchsorted(key[order], asked)]
    return np.asarray(place // 4), np.asarray(_SIDE[place % 4])


def _listed(numbers: IntArray) -> str:
    cut = range(0, len(numbers), _PER_LINE)
    return "".join(", ".join(map(str, numbers[k : k + _PER_LINE].tolist())) + "\n" for k in cut)
