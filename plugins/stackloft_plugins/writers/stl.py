"""STL, binary: triangles with their normals, single precision, millimetres.

::

    80 bytes of title | n: uint32 | n × (normal 3 × float32, corners 9 × float32, uint16 0)

The format has no unit field; millimetres are what printers and slicers take.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import BinaryIO, ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.model.arrays import FloatArray
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.writers.surface import TOLERANCE, triangles_of

_TITLE = b"stackloft, binary STL, unit mm"
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


@dataclass(frozen=True)
class StlWriter:
    """Writes a surface as binary STL in millimetres."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (LoftedSolid, TriMesh)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".stl",)

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
        corners = mesh.vertices[mesh.faces]
        records = np.zeros(len(corners), dtype=_RECORD)
        records["normal"] = _unit_normals(corners)
        records["corners"] = corners
        stream.write(_TITLE.ljust(80, b"\0"))
        stream.write(np.uint32(len(records)).astype("<u4").tobytes())
        stream.write(records.tobytes())


def _unit_normals(corners: FloatArray) -> FloatArray:
    """Return the outward unit normal of each triangle, (t, 3); zero where a triangle has no area."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    units: FloatArray = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    return units
