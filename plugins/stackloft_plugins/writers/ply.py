"""PLY, binary little endian: shared vertices in double precision, triangles as indices; millimetres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import BinaryIO, ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.writers.surface import TOLERANCE, triangles_of

_HEADER = """\
ply
format binary_little_endian 1.0
comment stackloft, unit mm
element vertex {vertices}
property double x
property double y
property double z
element face {faces}
property list uchar int vertex_indices
end_header
"""
_FACE = np.dtype([("count", "u1"), ("indices", "<i4", 3)])


@dataclass(frozen=True)
class PlyWriter:
    """Writes a surface as binary PLY in millimetres, vertices to full precision."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (LoftedSolid, TriMesh)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".ply",)

    tolerance: float = option(
        TOLERANCE, "greatest distance between a lofted solid and its triangles", unit="mm", gt=0
    )

    def write(self, product: LoftedSolid | TriMesh, stream: BinaryIO) -> None:
        """Write `product` to `stream`.

        Raises
        ------
        OutputError
            The surface is empty, not finite, or names vertices that do not exist.
        """
        mesh = triangles_of(product, self.tolerance)
        faces = np.zeros(len(mesh.faces), dtype=_FACE)
        faces["count"] = 3
        faces["indices"] = mesh.faces
        stream.write(_HEADER.format(vertices=len(mesh.vertices), faces=len(faces)).encode("ascii"))
        stream.write(mesh.vertices.astype("<f8").tobytes())
        stream.write(faces.tobytes())
