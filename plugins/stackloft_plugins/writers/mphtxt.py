"""COMSOL mphtxt: a mesh object of tri and tet (or tri2 and tet2), its groups as selections; millimetres.

Entity numbers of boundaries start from 0, of domains from 1. Second-order nodes are numbered row by row:
edges 01, 02, 12 of tri2; 01, 02, 12, 03, 13, 23 of tet2. (COMSOL Multiphysics Programming Reference Manual,
"The COMSOL File Formats".)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import BinaryIO, ClassVar

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import IntArray
from stackloft.model.tet_mesh import BODY, TetMesh
from stackloft_plugins.writers.rows import rows
from stackloft_plugins.writers.tets import checked

_TRI, _TET = [0, 1, 2, 3, 5, 4], [0, 1, 2, 3, 4, 6, 5, 7, 8, 9]
_MESH = "mesh1"


@dataclass(frozen=True)
class MphtxtWriter:
    """Writes tetrahedra of order 1 or 2 for COMSOL Multiphysics; its length unit must be set to mm there."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TetMesh,)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".mphtxt",)

    def write(self, product: TetMesh, stream: BinaryIO) -> None:
        """Write `product` to `stream`.

        Raises
        ------
        OutputError
            The mesh is not whole, or of order 3.
        """
        mesh = checked(product, "writer mphtxt")
        groups = mesh.group_of_faces()
        used, entity = np.unique(groups, return_inverse=True)
        names = [(mesh.group_names[k], 2, number) for number, k in enumerate(used.tolist())] + [(BODY, 3, 1)]
        tags = [_MESH, *(f"{_MESH}_sel{k}" for k in range(1, len(names) + 1))]
        parts = [
            "# stackloft, unit mm\n\n# Major & minor version\n0 1\n",
            f"{len(tags)} # number of tags\n# Tags\n",
            *(f"{_text(tag)}\n" for tag in tags),
            f"{len(tags)} # number of types\n# Types\n",
            *("3 obj\n" for _ in tags),
            _mesh(mesh, entity.reshape(-1)),
            *(_selection(number, *name) for number, name in enumerate(names, 1)),
        ]
        stream.write("".join(parts).encode("utf-8"))


def _mesh(mesh: TetMesh, entity: IntArray) -> str:
    tri, tet = ("tri", "tet") if mesh.order == 1 else ("tri2", "tet2")
    faces, elements = mesh.faces, mesh.elements
    if mesh.order == 2:
        faces, elements = faces[:, _TRI], elements[:, _TET]
    return "".join(
        [
            _object(0, "Mesh", 4),
            f"3 # sdim\n{len(mesh.nodes)} # number of mesh vertices\n0 # lowest mesh vertex index\n\n",
            f"# Mesh vertex coordinates\n{rows(mesh.nodes)}\n2 # number of element types\n",
            _elements(0, tri, faces, entity),
            _elements(1, tet, elements, np.ones(len(elements), dtype=np.int64)),
        ]
    )


def _elements(number: int, name: str, index: IntArray, entity: NDArray[np.int64]) -> str:
    return (
        f"\n# Type #{number}\n\n{_text(name)} # type name\n\n\n"
        f"{index.shape[1]} # number of vertices per element\n{len(index)} # number of elements\n"
        f"# Elements\n{rows(index)}\n"
        f"{len(entity)} # number of geometric entity indices\n# Geometric entity indices\n"
        f"{rows(entity[:, None])}"
    )


def _selection(number: int, name: str, dimension: int, entity: int) -> str:
    return (
        f"{_object(number, 'Selection', 0)}{_text(name)} # Label\n{_text(_MESH)} # Geometry/mesh tag\n"
        f"{dimension} # Dimension\n1 # Number of entities\n# Entities\n{entity}\n"
    )


def _object(number: int, kind: str, version: int) -> str:
    return f"\n# --------- Object {number} ----------\n\n0 0 1\n{_text(kind)} # class\n{version} # version\n"


def _text(text: str) -> str:
    """Return a string as the format holds it: its length, then itself."""
    return f"{len(text.encode())} {text}"
