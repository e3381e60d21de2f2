"""pytetwild in a process of its own: validated, centred, scaled to a unit box, limited, scaled back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, IntArray
from stackloft.model.errors import InputError
from stackloft.model.tri_mesh import TriMesh
from stackloft.model.tri_mesh_check import check_closed
from stackloft_plugins.worker import Limits, run_alone

WHERE = "mesher tetwild"
FINEST = 1e-5
"""Smallest envelope as a part of the box's diagonal; a tenth of fTetWild's practical one."""
MOST = 5e6
"""Elements that nobody wants to wait for."""
_FILL = 0.118
"""Volume of a regular tetrahedron of edge 1."""
_FLAT = 1e-9
"""Volume as a part of the box diagonal's cube below which a body has none."""
_FIXES = {
    "time": "give larger elements (max_element_size), a wider epsilon, or a longer time_limit",
    "memory": "give larger elements (max_element_size), or a higher memory_limit",
    "crash": "mend the surface with --method repair, or give another epsilon",
    "raised": "mend the surface with --method repair",
}


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is asked of fTetWild; lengths in mm."""

    size: float
    """ideal edge length"""
    epsilon: float
    """how far the boundary may be from the surface"""
    energy: float
    """AMIPS energy of the worst element at which it stops; 3 is a regular one's"""
    limits: Limits


def tetrahedra(
    surface: TriMesh, wanted: Wanted, field: tuple[FloatArray, IntArray, FloatArray] | None = None
) -> tuple[FloatArray, IntArray]:
    """Return nodes (n, 3), mm, and positive tetrahedra (m, 4) that fill a closed surface within epsilon.

    Parameters
    ----------
    surface : TriMesh
    wanted : Wanted
    field : points (k, 3), tetrahedra (l, 4) and edge lengths (k,), optional
        Wanted edge lengths from place to place, mm.

    Raises
    ------
    InputError
        A surface that encloses no body; an envelope or a size that cannot be; a crash, too much time or too
        much memory. This process goes on in every case.
    """
    check_body(surface)
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    middle, scale = 0.5 * (low + high), 1.0 / float((high - low).max())
    _check_wanted(surface, wanted, float(np.linalg.norm(high - low)))
    arrays: dict[str, NDArray[Any]] = {
        "vertices": (surface.vertices - middle) * scale,
        "faces": surface.faces.astype(np.int32),
    }
    if field is not None:
        points, cells, lengths = field
        arrays |= {
            "points": (points - middle) * scale,
            "cells": cells.astype(np.int32),
            "lengths": lengths * scale,
        }
    diagonal = float(np.linalg.norm(high - low))
    values = {"size": wanted.size * scale, "epsilon": wanted.epsilon / diagonal, "energy": wanted.energy}
    function = f"{__name__}:call"
    given = run_alone(function, arrays, values, wanted.limits, what="pytetwild", fixes=_FIXES)
    nodes, elements = given["nodes"], given["elements"].astype(np.int64)
    if not len(elements):
        raise InputError(
            "pytetwild found no inside", where=WHERE, fix="give a smaller epsilon, or --method repair"
        )
    return np.asarray(nodes / scale + middle), elements


def call(
    arrays: Mapping[str, NDArray[Any]], size: float, epsilon: float, energy: float
) -> dict[str, NDArray[Any]]:
    """Ask pytetwild; this runs in the worker, where a crash is an answer."""
    import pytetwild  # noqa: PLC0415 - it brings pyvista

    tetrahedralize: Any = pytetwild.tetrahedralize  # type: ignore[attr-defined]  # it exports nothing
    nodes, elements = tetrahedralize(
        arrays["vertices"],
        arrays["faces"],
        edge_length_abs=size,
        epsilon=epsilon,
        stop_energy=energy,
        num_threads=1,
        vtk_ordering=True,
        bg_vertices=arrays.get("points"),
        bg_tets=arrays.get("cells"),
        bg_values=arrays.get("lengths"),
    )
    used, index = np.unique(elements, return_inverse=True)
    return {"nodes": nodes[used], "elements": index.reshape(-1, 4)}


def check_body(surface: TriMesh) -> None:
    """Raise InputError unless `surface` is closed, oriented outward, and encloses a volume."""
    check_closed(surface)
    corners = surface.vertices[surface.faces] - surface.vertices[surface.faces[0, 0]]
    volume = float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6.0
    diagonal = float(np.linalg.norm(np.ptp(surface.vertices[surface.faces.ravel()], axis=0)))
    if not abs(volume) > _FLAT * diagonal**3:
        raise InputError(
            "the surface encloses no volume: it is flat, or a point",
            where=WHERE,
            found=f"{volume:g} mm³ in a box of {diagonal:g} mm",
        )
    if volume < 0.0:
        raise InputError("the surface is inside out", where=WHERE, found=f"volume {volume:g} mm³")


def _check_wanted(surface: TriMesh, wanted: Wanted, diagonal: float) -> None:
    if not wanted.epsilon >= FINEST * diagonal:
        raise InputError(
            "the envelope is too thin: fTetWild would not come to an end",
            where=f"{WHERE}, epsilon",
            found=f"{wanted.epsilon:g} mm",
            expected=f"{FINEST * diagonal:.3g} mm or more for a body of {diagonal:.4g} mm",
        )
    box = float(np.prod(np.ptp(surface.vertices, axis=0)))
    if not wanted.size > 0.0 or box / (_FILL * wanted.size**3) > 100 * MOST:
        raise InputError("elements so small are too many", where=f"{WHERE}, max_element_size",
                         found=f"{wanted.size:g} mm in a body of {diagonal:.4g} mm")  # fmt: skip
