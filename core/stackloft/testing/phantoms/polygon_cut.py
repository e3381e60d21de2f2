"""Sections of convex polyhedra: the exact polygon of half-planes, vertices only."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import Loop
from stackloft.testing.phantoms.body import Plane

_PARALLEL = 1e-9
_SLACK = 1e-11


def polygon_section(
    planes: Sequence[Plane], rotation: FloatArray, offset: FloatArray, z: float
) -> tuple[Loop, ...]:
    """Return the polygon in which the plane at `z` cuts the posed polyhedron; every vertex a corner.

    Every vertex is the solution of the two line equations that meet there, so it is exact to rounding.
    """
    normals = np.array([rotation @ plane.normal for plane in planes])
    distances = np.array([plane.distance for plane in planes]) + normals @ offset - normals[:, 2] * z
    keep = np.hypot(normals[:, 0], normals[:, 1]) > _PARALLEL
    lines, distances = normals[keep, :2], distances[keep]
    slack = _SLACK * (1 + np.abs(distances).max())
    vertices = []
    for i, j in combinations(range(len(lines)), 2):
        pair = lines[[i, j]]
        if abs(np.linalg.det(pair)) < _PARALLEL:
            continue
        vertex = np.linalg.solve(pair, distances[[i, j]])
        if (lines @ vertex <= distances + slack).all():
            vertices.append(vertex)
    return _counter_clockwise(_distinct(vertices, slack)) if len(vertices) >= 3 else ()


def _distinct(vertices: Sequence[FloatArray], slack: float) -> FloatArray:
    kept: list[FloatArray] = []
    for vertex in vertices:
        if all(np.hypot(*(vertex - other)) > 10 * slack for other in kept):
            kept.append(vertex)
    return np.array(kept)


def _counter_clockwise(vertices: FloatArray) -> tuple[Loop, ...]:
    if len(vertices) < 3:
        return ()
    x, y = (vertices - vertices.mean(axis=0)).T
    ordered = vertices[np.argsort(np.arctan2(y, x))]
    return (Loop(frozen_floats(ordered), frozen_ints(range(len(ordered)))),)
