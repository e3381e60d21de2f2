"""The nearest point of a triangle surface, by VTK's cell locator."""

from __future__ import annotations

from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray


class ClosestTriangle:
    """A triangle surface that points are projected on.

    Parameters
    ----------
    vertices : (n, 3) array, mm
    faces : (t, 3) int array

    Examples
    --------
    >>> surface = ClosestTriangle(np.eye(3), np.array([[0, 1, 2]]))
    >>> foot, which, distance = surface.project(np.array([[1.0, 1.0, 1.0]]))
    >>> foot.round(9).tolist(), which.tolist(), float(distance[0].round(6))
    ([[0.333333333, 0.333333333, 0.333333333]], [0], 1.154701)
    """

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        from vtkmodules.util import numpy_support  # noqa: PLC0415 - VTK is heavy
        from vtkmodules.vtkCommonCore import vtkPoints  # noqa: PLC0415
        from vtkmodules.vtkCommonDataModel import (  # noqa: PLC0415
            vtkCellArray,
            vtkPolyData,
            vtkStaticCellLocator,
        )

        as_vtk: Any = numpy_support.numpy_to_vtk  # VTK has no annotations
        as_ids: Any = numpy_support.numpy_to_vtkIdTypeArray
        points, cells, self._data = vtkPoints(), vtkCellArray(), vtkPolyData()
        points.SetDataTypeToDouble()
        points.SetData(as_vtk(np.ascontiguousarray(vertices, dtype=np.float64), deep=True))
        offsets = np.arange(0, 3 * len(faces) + 1, 3, dtype=np.int64)
        cells.SetData(as_ids(offsets, deep=True), as_ids(np.array(faces.ravel(), dtype=np.int64), deep=True))
        self._data.SetPoints(points)
        self._data.SetPolys(cells)
        self._locator: Any = vtkStaticCellLocator()  # its declared signatures know no references
        self._locator.SetDataSet(self._data)
        self._locator.BuildLocator()

    def project(self, points: FloatArray) -> tuple[FloatArray, IntArray, FloatArray]:
        """Return the nearest point (n, 3), its triangle (n,) and its distance (n,) for each of `points`."""
        from vtkmodules.vtkCommonCore import mutable  # noqa: PLC0415
        from vtkmodules.vtkCommonDataModel import vtkGenericCell  # noqa: PLC0415

        cell, which, part, squared = vtkGenericCell(), mutable(0), mutable(0), mutable(0.0)
        found: list[float] = [0.0, 0.0, 0.0]
        feet, owners = np.empty((len(points), 3)), np.empty(len(points), dtype=np.int64)
        for k, point in enumerate(np.asarray(points, dtype=np.float64).tolist()):
            self._locator.FindClosestPoint(point, found, cell, which, part, squared)
            feet[k], owners[k] = found, int(which)
        return feet, owners, np.linalg.norm(feet - points, axis=1)
