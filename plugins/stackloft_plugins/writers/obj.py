"""Wavefront OBJ: vertices to full precision and triangles, counted from 1; millimetres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import BinaryIO, ClassVar

from stackloft.contracts.options import option
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.writers.rows import rows
from stackloft_plugins.writers.surface import TOLERANCE, triangles_of


@dataclass(frozen=True)
class ObjWriter:
    """Writes a surface as OBJ in millimetres, vertices to full precision."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (LoftedSolid, TriMesh)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".obj",)

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
        text = "# stackloft, unit mm\n" + rows(mesh.vertices, "v ") + rows(mesh.faces + 1, "f ")
        stream.write(text.encode("ascii"))
