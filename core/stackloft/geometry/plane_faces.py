"""Plane faces with openings, cut into triangles."""

from __future__ import annotations

from itertools import pairwise

import mapbox_earcut
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def group_rims(
    points: FloatArray, rims: list[tuple[float, IntArray]]
) -> list[tuple[IntArray, list[IntArray]]]:
    """Return each face's rim with the rims of its openings.

    Parameters
    ----------
    points : (n, 3) array, mm
    rims : list of (sign, ring)
        1 for a face, -1 for an opening; rings of vertex numbers, each in a plane across z.
    """
    faces = [ring for sign, ring in rims if sign > 0.0]
    found: list[tuple[IntArray, list[IntArray]]] = [(ring, []) for ring in faces]
    for sign, ring in rims:
        if sign < 0.0:
            found[_face_around(points, faces, points[ring])][1].append(ring)
    return found


def _face_around(points: FloatArray, faces: list[IntArray], opening: FloatArray) -> int:
    """Return the smallest face in the opening's plane that holds it."""
    best, least = -1, np.inf
    height = float(opening[0, 2])
    for k, ring in enumerate(faces):
        rim = points[ring]
        size = float(np.ptp(rim, axis=0).max())
        if abs(float(rim[0, 2]) - height) > 1e-6 * size:
            continue
        if size < least and _inside(opening[:, :2], rim[:, :2]).mean() > 0.5:
            best, least = k, size
    if best < 0:
        message = f"an opening at z = {height:g} mm lies in no face"
        raise ValueError(message)
    return best


def _inside(points: FloatArray, polygon: FloatArray) -> NDArray[np.bool_]:
    x0, y0 = polygon.T
    x1, y1 = np.roll(polygon, -1, axis=0).T
    x, y = points[:, :1], points[:, 1:]
    spans = (y0 > y) != (y1 > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossed = x < x0 + (y - y0) * (x1 - x0) / (y1 - y0)
    return np.asarray(np.count_nonzero(spans & crossed, axis=1) % 2 == 1)


def cut_face(points: FloatArray, outer: IntArray, openings: list[IntArray]) -> IntArray:
    """Return triangles between a plane rim and its openings, turning as the rim does.

    Parameters
    ----------
    points : (n, 3) array, mm
    outer : (k,) int array
        The rim, counter-clockwise seen from outside.
    openings : list of int arrays
        Rims of openings, in either direction.
    """
    rings = [outer, *openings]
    every = np.concatenate(rings)
    rim = points[every]
    outline = points[outer] - points[outer].mean(axis=0)
    normal = np.cross(outline, np.roll(outline, -1, axis=0)).sum(axis=0)
    drop = int(np.argmax(np.abs(normal)))
    plane = np.ascontiguousarray(np.delete(rim - rim.mean(axis=0), drop, axis=1))
    stops = np.cumsum([len(ring) for ring in rings]).astype(np.uint32)
    cut = mapbox_earcut.triangulate_float64(plane, stops)
    triangles = every[cut.astype(np.int64).reshape(-1, 3)]
    sense = np.cross(
        points[triangles[:, 1]] - points[triangles[:, 0]],
        points[triangles[:, 2]] - points[triangles[:, 0]],
    ) @ normal  # fmt: skip
    if sense.sum() < 0.0:  # all turn the same way; slivers' own sign is rounding
        triangles = triangles[:, ::-1]
    for ring in rings:
        triangles = _with_all_rim_points(triangles, ring)
    return triangles


def _with_all_rim_points(triangles: IntArray, ring: IntArray) -> IntArray:
    """Return the triangles with rim points put back that the cutter left out as collinear.

    The triangle on the rim's edge from a kept point to the next kept one becomes a fan over the points
    between, so that the face shares every edge of the rim with the side.
    """
    kept = np.flatnonzero(np.isin(ring, triangles))
    if len(kept) == len(ring):
        return triangles
    following = np.append(kept[1:], kept[0] + len(ring))
    result = [tuple(int(k) for k in triangle) for triangle in triangles]
    for a, b in zip(kept, following, strict=True):
        if b == a + 1:
            continue
        run = ring[np.arange(a, b + 1) % len(ring)]
        at, apex, forward = _triangle_on_edge(result, int(run[0]), int(run[-1]))
        result[at : at + 1] = [
            (int(p), int(q), apex) if forward else (int(q), int(p), apex) for p, q in pairwise(run)
        ]
    return np.array(result, dtype=np.int64)


def _triangle_on_edge(triangles: list[tuple[int, ...]], a: int, b: int) -> tuple[int, int, bool]:
    """Return place and third corner of the triangle with the edge a → b, and whether it runs that way."""
    for at, (p, q, r) in enumerate(triangles):
        for start, end, apex in ((p, q, r), (q, r, p), (r, p, q)):
            if (start, end) == (a, b):
                return at, apex, True
            if (start, end) == (b, a):
                return at, apex, False
    message = f"no triangle on the rim's edge {a} → {b}"
    raise ValueError(message)
