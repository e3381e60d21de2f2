"""Flying edges: the triangle surface on which a field over a grid is zero."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, IntArray

_APART = 1e-6
"""Grid values that are zero are moved down by this part of the largest: no vertex then falls on a node."""


def zero_surface(field: NDArray[Any]) -> tuple[FloatArray, IntArray]:
    """Return the zero surface of a field, trilinear between nodes.

    VTK's flying edges (Schroeder, Maynard & Geveci 2015, IEEE LDAV 33), which is marching cubes (Lorensen
    & Cline 1987) with shared vertices, so that the surface is closed but
    for the grid's border.

    Parameters
    ----------
    field : (slices, rows, columns) array
        Positive inside.

    Returns
    -------
    vertices : (n, 3) float array
        (column, row, slice) in grid steps from node (0, 0, 0).
    faces : (t, 3) int array
        Counter-clockwise seen from where the field is negative.

    Examples
    --------
    >>> field = -np.ones((3, 3, 3))
    >>> field[1, 1, 1] = 1.0
    >>> vertices, faces = zero_surface(field)
    >>> len(vertices), len(faces), float(vertices.min()), float(vertices.max())
    (6, 8, 0.5, 1.5)
    """
    from vtkmodules.util import numpy_support  # noqa: PLC0415 - VTK is heavy
    from vtkmodules.vtkCommonDataModel import vtkImageData  # noqa: PLC0415
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D  # noqa: PLC0415

    as_vtk: Any = numpy_support.numpy_to_vtk  # VTK has no annotations
    as_numpy: Any = numpy_support.vtk_to_numpy
    values = np.ascontiguousarray(field, dtype=np.float32)
    nodes = values == 0.0
    if nodes.any():
        largest = max(float(values.max()), -float(values.min()), 1e-30)
        values = np.where(nodes, np.float32(-_APART * largest), values)
    image = vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.GetPointData().SetScalars(as_vtk(values.ravel(), deep=False))
    edges = vtkFlyingEdges3D()
    edges.SetInputData(image)
    edges.SetValue(0, 0.0)
    edges.ComputeNormalsOff()
    edges.ComputeGradientsOff()
    edges.ComputeScalarsOff()
    edges.Update()
    surface = edges.GetOutput()
    if not surface.GetNumberOfPolys():
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    vertices = as_numpy(surface.GetPoints().GetData()).astype(np.float64)
    faces = as_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(np.int64)
    return vertices, faces
