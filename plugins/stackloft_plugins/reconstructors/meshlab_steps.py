"""Mending a triangle surface by MeshLab's filters, one after the other; this runs in a worker.

Each step leaves a row: what it changed in triangles, volume and area. A volume means something only when the
surface is closed, and MeshLab has none for an open one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

LIBRARIES = "libGL.so", "libOpenGL.so"
STEPS = (
    "duplicate vertices",
    "duplicate triangles",
    "degenerate triangles",
    "non-manifold edges",
    "self-intersections",
    "holes",
    "orientation",
    "remeshing",
)
"""Steps in their order."""


def mend(
    arrays: Mapping[str, NDArray[Any]], hole: int, intersections: bool, edge: float
) -> dict[str, NDArray[Any]]:
    """Return the mended surface, and a row per step: triangles, area, volume (NaN: open).

    Parameters
    ----------
    arrays : mapping
        ``vertices`` (n, 3) and ``faces`` (t, 3).
    hole : int
        Most edges of a hole that is closed.
    intersections : bool
        Whether triangles that cut each other are taken out, and the hole closed.
    edge : float
        Edge length for remeshing; 0: none.
    """
    import pymeshlab  # noqa: PLC0415 - needs libGL

    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(
        pymeshlab.Mesh(arrays["vertices"].astype(np.float64), arrays["faces"].astype(np.int32)), "surface"
    )
    rows = [_state(meshes)]
    for action in _actions(pymeshlab, meshes, hole, intersections, edge):
        action()
        rows.append(_state(meshes))
    mended = meshes.current_mesh()
    mended.compact()
    return {
        "vertices": np.array(mended.vertex_matrix(), dtype=np.float64),
        "faces": np.array(mended.face_matrix(), dtype=np.int64),
        "rows": np.array(rows),
    }


def _actions(
    pymeshlab: Any, meshes: Any, hole: int, intersections: bool, edge: float
) -> tuple[Callable[[], None], ...]:
    return (
        meshes.meshing_remove_duplicate_vertices,
        meshes.meshing_remove_duplicate_faces,
        meshes.meshing_remove_null_faces,
        partial(_without_crowds, pymeshlab, meshes),
        partial(_without_crossings, meshes, intersections),
        partial(_without_holes, meshes, hole),
        partial(_outward, meshes),
        partial(_remeshed, pymeshlab, meshes, edge),
    )


def _without_crowds(pymeshlab: Any, meshes: Any) -> None:
    """Take out fins, then whatever MeshLab takes out where three triangles and more share an edge."""
    mesh = meshes.current_mesh()
    faces = np.array(mesh.face_matrix(), dtype=np.int64)
    kept = without_fins(faces)
    if len(kept) < len(faces):
        meshes.add_mesh(pymeshlab.Mesh(np.array(mesh.vertex_matrix()), kept.astype(np.int32)), "surface")
        meshes.meshing_remove_unreferenced_vertices()
    meshes.meshing_repair_non_manifold_edges(method="Remove Faces")
    meshes.meshing_repair_non_manifold_vertices()


def without_fins(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the triangles without those that have a free edge and one that three and more share.

    Examples
    --------
    >>> pyramid = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    >>> len(without_fins(np.array([*pyramid, [0, 1, 4]])))
    4
    """
    while len(faces):
        ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        _, which, uses = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
        count = uses[which.reshape(-1)].reshape(-1, 3)
        fin = (count == 1).any(axis=1) & (count > 2).any(axis=1)
        if not fin.any():
            break
        faces = faces[~fin]
    return faces


def _without_crossings(meshes: Any, wanted: bool) -> None:
    if not wanted:
        return
    meshes.compute_selection_by_self_intersections_per_face()
    if meshes.current_mesh().selected_face_number():
        meshes.meshing_remove_selected_faces()
        meshes.meshing_repair_non_manifold_edges(method="Remove Faces")


def _without_holes(meshes: Any, largest: int) -> None:
    """Close holes, first those that can be closed without new crossings."""
    if not largest:
        return
    meshes.meshing_re_orient_faces_coherently()
    meshes.meshing_close_holes(maxholesize=largest, selfintersection=True)
    meshes.meshing_close_holes(maxholesize=largest, selfintersection=False)


def _outward(meshes: Any) -> None:
    meshes.meshing_re_orient_faces_coherently()
    if _state(meshes)[2] < 0:
        meshes.meshing_invert_face_orientation()


def _remeshed(pymeshlab: Any, meshes: Any, edge: float) -> None:
    if edge:
        meshes.meshing_isotropic_explicit_remeshing(targetlen=pymeshlab.PureValue(edge), iterations=10)


def _state(meshes: Any) -> tuple[float, float, float]:
    """Return triangles, area, and volume; NaN when the surface is open."""
    measures = meshes.get_geometric_measures()
    area = float(measures.get("surface_area", np.nan))
    volume = measures.get("mesh_volume")
    return float(meshes.current_mesh().face_number()), area, np.nan if volume is None else float(volume)
