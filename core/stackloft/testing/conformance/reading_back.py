"""Meshes read back by a library that did not write them."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from stackloft.geometry.tet_boundary import boundary_faces
from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tri_mesh import TriMesh
from stackloft.testing.conformance.check import NonconformingError, must


def read_surface(path: Path) -> TriMesh:
    """Return the triangles of a file in a format that meshio knows; equal vertices are joined."""
    mesh = _by_meshio(path)
    corners = np.concatenate([block.data for block in mesh.cells if block.type == "triangle"])
    vertices, index = np.unique(mesh.points[corners.ravel()], axis=0, return_inverse=True)
    return TriMesh(frozen_floats(vertices), frozen_ints(index.reshape(-1, 3)))


def _by_meshio(path: Path) -> Any:
    import meshio  # noqa: PLC0415 - slow to import

    try:
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            return meshio.read(path)
    except (Exception, SystemExit) as error:
        message = f"meshio cannot read the {path.suffix} file: {type(error).__name__} {error}"
        raise NonconformingError(message) from error


def read_tets(path: Path) -> TetMesh:
    """Return the tetrahedra of a file in a format that meshio knows; the boundary is found from them."""
    mesh = _by_meshio(path)
    elements = next((block.data for block in mesh.cells if block.type in {"tetra", "tetra10"}), None)
    must(elements is not None, f"meshio finds no tetrahedra in the {path.suffix} file")
    whole = frozen_ints(np.asarray(elements))
    return TetMesh(frozen_floats(mesh.points), whole, frozen_ints(boundary_faces(whole)))
