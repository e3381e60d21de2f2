"""VTU: VTK's unstructured grid, XML; tetrahedra and their boundary of order 1 to 3; millimetres.

Cell data ``group`` numbers the groups: 0 the body, 1 and on those of the boundary; field data ``group NAME``
holds each one's number (numbers alone, as not every reader takes text). ParaView shows order 2 and 3 curved
at a nonlinear subdivision level of 2 and more.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, BinaryIO, ClassVar

import numpy as np

from stackloft.model.tet_mesh import BODY, TetMesh
from stackloft_plugins.writers.tets import checked

_TRIANGLE = {1: 5, 2: 22, 3: 69}
_TET = {1: 10, 2: 24, 3: 71}
"""VTK_TRIANGLE, QUADRATIC_TRIANGLE, LAGRANGE_TRIANGLE; VTK_TETRA, QUADRATIC_TETRA, LAGRANGE_TETRAHEDRON"""


@dataclass(frozen=True)
class VtuWriter:
    """Writes tetrahedra of order 1 to 3 and their boundary for ParaView and what reads VTK's files."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TetMesh,)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".vtu",)

    def write(self, product: TetMesh, stream: BinaryIO) -> None:
        """Write `product` to `stream`.

        Raises
        ------
        OutputError
            The mesh is not whole.
        """
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter  # noqa: PLC0415 - VTK is heavy

        writer = vtkXMLUnstructuredGridWriter()
        writer.SetInputData(_grid(checked(product, "writer vtu", highest=3)))
        writer.SetDataModeToBinary()
        writer.SetWriteToOutputString(True)
        writer.Write()
        text: str = writer.GetOutputString()
        stream.write(text.encode("utf-8"))


def _grid(mesh: TetMesh) -> Any:
    from vtkmodules.util import numpy_support  # noqa: PLC0415 - VTK is heavy
    from vtkmodules.vtkCommonCore import vtkPoints  # noqa: PLC0415
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid  # noqa: PLC0415

    as_vtk: Any = numpy_support.numpy_to_vtk  # VTK has no annotations
    as_ids: Any = numpy_support.numpy_to_vtkIdTypeArray
    sizes = np.repeat([mesh.elements.shape[1], mesh.faces.shape[1]], [len(mesh.elements), len(mesh.faces)])
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    kinds = np.repeat([_TET[mesh.order], _TRIANGLE[mesh.order]], [len(mesh.elements), len(mesh.faces)])
    index = np.concatenate([mesh.elements.ravel(), mesh.faces.ravel()]).astype(np.int64)
    points, cells, grid = vtkPoints(), vtkCellArray(), vtkUnstructuredGrid()
    points.SetDataTypeToDouble()
    points.SetData(as_vtk(np.ascontiguousarray(mesh.nodes), deep=True))
    cells.SetData(as_ids(offsets, deep=True), as_ids(index, deep=True))
    grid.SetPoints(points)
    grid.SetCells(as_vtk(kinds.astype(np.uint8), deep=True), cells)
    group = as_vtk(
        np.concatenate([np.zeros(len(mesh.elements)), mesh.group_of_faces() + 1]).astype(np.int32), deep=True
    )
    group.SetName("group")
    grid.GetCellData().AddArray(group)
    for k, name in enumerate((BODY, *mesh.group_names)):
        number = as_vtk(np.array([k], dtype=np.int32), deep=True)
        number.SetName(f"group {name}")
        grid.GetFieldData().AddArray(number)
    return grid
