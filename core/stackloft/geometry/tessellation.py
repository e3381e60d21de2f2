r"""A tube of bicubic patches as closed triangles, to a tolerance.

::

    pole        plane face
     /|\        +--+--+     rows of quadrilaterals, each split along its
    / | \       |\ |\ |     shorter diagonal; poles fan out, plane faces
   +--+--+      +--+--+     are cut into triangles between their rim points
"""

from __future__ import annotations

import math
from itertools import pairwise

import mapbox_earcut
import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.bezier_patch import bernstein, evaluate

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

FINEST = 64
"""Most subdivisions of one patch in one direction."""


def tessellate_tube(
    patches: FloatArray, plane_ends: tuple[bool, bool], tolerance: float
) -> tuple[FloatArray, IntArray]:
    """Return a closed triangle surface within `tolerance` of the patches.

    Parameters
    ----------
    patches : (rows, columns, 4, 4, 3) array
        Bézier control points [v, u], mm.
    plane_ends : pair of bool
        Where a plane face closes the tube; elsewhere it ends in a pole.
    tolerance : float
        Largest wanted distance between triangles and surface, mm.

    Returns
    -------
    vertices : (n, 3) array, mm
    faces : (t, 3) int array
        Outward (counter-clockwise from outside).
    """
    along_v, along_u = _subdivisions(patches, tolerance)
    grid = _grid(patches, along_v, along_u)
    return _stitched(grid, plane_ends)


def _subdivisions(patches: FloatArray, tolerance: float) -> tuple[int, int]:
    """Return how often to cut each patch so that chords and twist stay within the tolerance.

    A cubic strays from a chord over 1/n of it by at most 6·max|Δ²b|/(8n²); a patch's twist adds at most
    9·max|Δu Δv b|/(4 n_u n_v).
    """
    bend_v = np.linalg.norm(np.diff(patches, 2, axis=-3), axis=-1).max()
    bend_u = np.linalg.norm(np.diff(patches, 2, axis=-2), axis=-1).max()
    twist = np.linalg.norm(np.diff(np.diff(patches, axis=-3), axis=-2), axis=-1).max()
    share = tolerance / 3.0
    n_v = max(1, math.ceil(math.sqrt(0.75 * bend_v / share)))
    n_u = max(1, math.ceil(math.sqrt(0.75 * bend_u / share)))
    while 2.25 * twist > share * n_u * n_v and min(n_u, n_v) < FINEST:
        n_u, n_v = (n_u + 1, n_v) if n_u <= n_v else (n_u, n_v + 1)
    return min(n_v, FINEST), min(n_u, FINEST)


def _grid(patches: FloatArray, n_v: int, n_u: int) -> FloatArray:
    """Return points (rows·n_v + 1, columns·n_u, 3) on the surface; columns close on themselves."""
    u = bernstein(np.arange(n_u) / n_u)
    inner = evaluate(patches, bernstein(np.arange(n_v) / n_v), u)
    rows, columns = patches.shape[:2]
    body = np.moveaxis(inner, 2, 1).reshape(rows * n_v, columns * n_u, 3)
    top = evaluate(patches[-1:], bernstein(np.ones(1)), u)
    return np.concatenate([body, np.moveaxis(top, 2, 1).reshape(1, columns * n_u, 3)])


def _stitched(grid: FloatArray, plane_ends: tuple[bool, bool]) -> tuple[FloatArray, IntArray]:
    """Return vertices and faces of a grid of rings closed at both ends."""
    rings, around, _ = grid.shape
    first = 0 if plane_ends[0] else 1
    last = rings if plane_ends[1] else rings - 1
    vertices = [grid[first:last].reshape(-1, 3)]
    index = np.arange((last - first) * around).reshape(-1, around)
    count = index.size
    faces = [_quads(grid[first:last], index)]
    for at_last, plane in enumerate(plane_ends):
        ring = index[-1] if at_last else index[0][::-1]
        if plane:
            faces.append(_plane_face(vertices[0], ring))
        else:
            vertices.append(grid[-1, :1] if at_last else grid[0, :1])
            faces.append(np.stack([ring, np.roll(ring, -1), np.full(around, count)], axis=1))
            count += 1
    return np.concatenate(vertices), np.concatenate(faces)


def _quads(grid: FloatArray, index: IntArray) -> IntArray:
    """Return two triangles per quadrilateral, split along the shorter diagonal."""
    a, b = index[:-1].ravel(), np.roll(index[:-1], -1, axis=1).ravel()
    d, c = index[1:].ravel(), np.roll(index[1:], -1, axis=1).ravel()
    points = grid.reshape(-1, 3)
    straight = np.linalg.norm(points[a] - points[c], axis=1) <= np.linalg.norm(points[b] - points[d], axis=1)
    one = np.where(straight[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    two = np.where(straight[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.concatenate([one, two])


def _plane_face(vertices: FloatArray, ring: IntArray) -> IntArray:
    """Return triangles between the rim's points, counter-clockwise as the rim."""
    rim = vertices[ring]
    centred = rim - rim.mean(axis=0)
    normal = np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)
    drop = int(np.argmax(np.abs(normal)))
    plane = np.ascontiguousarray(np.delete(centred, drop, axis=1))
    cut = mapbox_earcut.triangulate_float64(plane, np.array([len(ring)], dtype=np.uint32))
    triangles = ring[cut.astype(np.int64).reshape(-1, 3)]
    sense = np.cross(
        vertices[triangles[:, 1]] - vertices[triangles[:, 0]],
        vertices[triangles[:, 2]] - vertices[triangles[:, 0]],
    ) @ normal  # fmt: skip
    if sense.sum() < 0.0:  # all turn the same way; slivers' own sign is rounding
        triangles = triangles[:, ::-1]
    return _with_all_rim_points(triangles, ring)


def _with_all_rim_points(triangles: IntArray, ring: IntArray) -> IntArray:
    """Return the triangles with rim points put back that the cutter left out as collinear.

    The triangle on the rim's edge from a kept point to the next kept one becomes a fan over the points
    between, so that the face shares every edge of the rim with the side.
    """
    kept = np.flatnonzero(np.isin(ring, triangles))
    following = np.append(kept[1:], kept[0] + len(ring))
    result = [tuple(int(k) for k in triangle) for triangle in triangles]
    for a, b in zip(kept, following, strict=True):
        if b == a + 1:
            continue
        run = ring[np.arange(a, b + 1) % len(ring)]
        at, apex = _triangle_on_edge(result, int(run[0]), int(run[-1]))
        result[at : at + 1] = [(int(p), int(q), apex) for p, q in pairwise(run)]
    return np.array(result, dtype=np.int64)


def _triangle_on_edge(triangles: list[tuple[int, ...]], a: int, b: int) -> tuple[int, int]:
    """Return the place and the third corner of the triangle with the directed edge a → b."""
    for at, (p, q, r) in enumerate(triangles):
        for start, end, apex in ((p, q, r), (q, r, p), (r, p, q)):
            if (start, end) == (a, b):
                return at, apex
    message = f"no triangle on the rim's edge {a} → {b}"
    raise ValueError(message)
