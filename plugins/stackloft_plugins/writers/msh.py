r"""Gmsh MSH 4.1, text: nodes, boundary triangles and tetrahedra, with named physical groups; millimetres.

::

    $PhysicalNames   2 1 "side" … 3 1 "body"       dimension, tag, name
    $Entities        a surface for each boundary group, one volume
    $Nodes           all on the volume
    $Elements        triangles (type 2 or 9) by surface, tetrahedra (4 or 11); the last two edge nodes of
                     type 11 are exchanged

Gmsh reference manual, "MSH file format" (version 4.1); Geuzaine & Remacle (2009).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import BinaryIO, ClassVar

import numpy as np

from stackloft.model.arrays import IntArray
from stackloft.model.tet_mesh import BODY, TetMesh
from stackloft_plugins.writers.rows import rows
from stackloft_plugins.writers.tets import checked

_TRIANGLE = {1: 2, 2: 9}
_TET = {1: 4, 2: 11}
_GMSH = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]


@dataclass(frozen=True)
class MshWriter:
    """Writes tetrahedra of order 1 or 2 with their boundary for Gmsh and what reads its files."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TetMesh,)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".msh",)

    def write(self, product: TetMesh, stream: BinaryIO) -> None:
        """Write `product` to `stream`.

        Raises
        ------
        OutputError
            The mesh is not whole, or of order 3.
        """
        mesh = checked(product, "writer msh")
        parts = [
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n",
            _names(mesh),
            _entities(mesh),
            _nodes(mesh),
            _elements(mesh),
        ]
        stream.write("".join(parts).encode("utf-8"))


def _used(mesh: TetMesh) -> list[int]:
    """Return the boundary groups that have faces."""
    return [int(k) for k in np.unique(mesh.group_of_faces())]


def _names(mesh: TetMesh) -> str:
    used = _used(mesh)
    lines = [f'2 {k + 1} "{mesh.group_names[k]}"' for k in used] + [f'3 1 "{BODY}"']
    return "\n".join(["$PhysicalNames", str(len(lines)), *lines, "$EndPhysicalNames\n"])


def _entities(mesh: TetMesh) -> str:
    groups = mesh.group_of_faces()
    lines = [f"{k + 1} {_box(mesh, mesh.faces[groups == k])} 1 {k + 1} 0" for k in _used(mesh)]
    surfaces = " ".join(str(k + 1) for k in _used(mesh))
    lines.append(f"1 {_box(mesh, mesh.elements)} 1 1 {len(_used(mesh))} {surfaces}")
    return "\n".join(["$Entities", f"0 0 {len(lines) - 1} 1", *lines, "$EndEntities\n"])


def _box(mesh: TetMesh, index: IntArray) -> str:
    points = mesh.nodes[index.ravel()]
    return " ".join(map(repr, [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]))


def _nodes(mesh: TetMesh) -> str:
    count = len(mesh.nodes)
    tags = "".join(f"{k}\n" for k in range(1, count + 1))
    return f"$Nodes\n1 {count} 1 {count}\n3 1 0 {count}\n{tags}{rows(mesh.nodes)}$EndNodes\n"


def _elements(mesh: TetMesh) -> str:
    groups, used = mesh.group_of_faces(), _used(mesh)
    total = len(mesh.faces) + len(mesh.elements)
    parts, first = [f"$Elements\n{len(used) + 1} {total} 1 {total}\n"], 1
    for k in used:
        faces = mesh.faces[groups == k]
        parts += [f"2 {k + 1} {_TRIANGLE[mesh.order]} {len(faces)}\n", rows(faces + 1, first=first)]
        first += len(faces)
    elements = mesh.elements if mesh.order == 1 else mesh.elements[:, _GMSH]
    parts += [f"3 1 {_TET[mesh.order]} {len(elements)}\n", rows(elements + 1, first=first), "$EndElements\n"]
    return "".join(parts)
