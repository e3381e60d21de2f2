"""Repair: a triangle surface mended until it encloses a body, by MeshLab."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.errors import InputError, PluginError
from stackloft.model.notices import Notice
from stackloft.model.tri_mesh import TriMesh
from stackloft.model.tri_mesh_check import check_closed, check_triangles
from stackloft_plugins.reconstructors.meshlab_steps import LIBRARIES, STEPS
from stackloft_plugins.worker import Limits, WorkerError, run_alone

WHERE = "reconstructor repair"


@dataclass(frozen=True)
class Repair:
    """Takes out duplicate and degenerate triangles, non-manifold edges and self-intersections, closes holes.

    MeshLab's filters, in a process of their own, as some inputs crash it. What each step changed in volume
    and area is told in notices, so that nobody measures a surface that the repair made up: a hole that is
    closed is flat, and triangles that cut each other are replaced. What stays open is refused.
    """

    hole_size: int = option(100, "most edges of a hole that is closed; 0: holes stay", ge=0)
    intersections: bool = option(True, "take out triangles that cut each other, and close the gap")
    edge_length: float | None = option(
        None, "edge length of isotropic remeshing; no remeshing when not given", unit="mm", gt=0
    )
    time_limit: float = option(300.0, "longest time", unit="s", gt=0)
    memory_limit: float = option(4000.0, "most memory", unit="MB", gt=0)

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TriMesh,)
    produces: ClassVar[tuple[type, ...]] = (TriMesh,)

    def reconstruct(self, product: TriMesh) -> TriMesh:
        """Return a closed, oriented surface with notices of what was changed.

        Raises
        ------
        InputError
            No triangles, vertices that are not finite, a surface that stays open, or MeshLab crashed.
        PluginError
            pymeshlab cannot be imported: which system packages are missing.
        """
        check_triangles(product)
        low, high = product.vertices.min(axis=0), product.vertices.max(axis=0)
        middle, scale = 0.5 * (low + high), float((high - low).max())
        if not scale > 0.0:
            raise InputError("the surface is a point", where=WHERE)
        arrays = {"vertices": (product.vertices - middle) / scale, "faces": product.faces}
        values = {
            "hole": self.hole_size,
            "intersections": self.intersections,
            "edge": (self.edge_length or 0.0) / scale,
        }
        given = _asked(arrays, values, Limits(self.time_limit, self.memory_limit))
        if not len(given["faces"]):
            raise InputError("nothing is left of the surface", where=WHERE, fix="give a better surface")
        notices = (*product.notices, *_changes(given["rows"], scale))
        vertices = frozen_floats(given["vertices"] * scale + middle)
        mended = TriMesh(vertices, frozen_ints(given["faces"]), product.biased, notices=notices)
        try:
            check_closed(mended)
        except InputError as error:
            raise InputError(
                "the surface stays open after repair",
                where=WHERE,
                found=error.found,
                fix=f"give a hole_size above {self.hole_size}, or mend it by hand",
            ) from error
        return mended


def _asked(arrays: dict[str, FloatArray], values: dict[str, float], limits: Limits) -> dict[str, FloatArray]:
    function = "stackloft_plugins.reconstructors.meshlab_steps:mend"
    try:
        return run_alone(function, arrays, values, limits, what="pymeshlab")
    except WorkerError as error:
        found = error.found or ""
        if "ImportError" in found and any(library in found for library in LIBRARIES):
            raise PluginError(
                "pymeshlab cannot be imported: a system library is missing",
                where=WHERE,
                found=found,
                fix="apt-get install libgl1 libopengl0 (everything else works without it)",
            ) from error
        raise


def _changes(rows: FloatArray, scale: float) -> list[Notice]:
    """Return a notice for each step that changed anything."""
    told = []
    for name, before, after in zip(STEPS, rows[:-1], rows[1:], strict=True):
        if np.array_equal(before, after, equal_nan=True):
            continue
        faces = int(after[0] - before[0])
        words = [f"{faces:+d} triangles"] if faces else []
        words.append(f"area {scale**2 * (after[1] - before[1]):+.4g} mm²")
        closed = [not math.isnan(row[2]) for row in (before, after)]
        if all(closed):
            words.append(f"volume {scale**3 * (after[2] - before[2]):+.4g} mm³")
        elif closed[1]:
            words.append(f"now closed, volume {scale**3 * after[2]:.6g} mm³")
        elif closed[0]:
            words.append("now open")
        told.append(Notice("surface-repaired", f"repair, {name}: {', '.join(words)}"))
    return told
