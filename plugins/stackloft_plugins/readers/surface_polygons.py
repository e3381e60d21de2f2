"""Polygons of a surface file cut into triangles."""

from __future__ import annotations

from collections.abc import Sequence

import mapbox_earcut
import numpy as np

from stackloft.model.arrays import FloatArray, IntArray


def triangles(vertices: FloatArray, loops: Sequence[Sequence[int]] | IntArray) -> IntArray:
    """Return every polygon as triangles, (t, 3), in its own sense.

    Convex polygons become fans; others are cut in their own plane (ear clipping).

    Raises
    ------
    ValueError
        A polygon of fewer than three corners, or one that names no vertex.

    Examples
    --------
    >>> square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> triangles(square, [[0, 1, 2, 3]]).tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    if not len(loops):
        return np.zeros((0, 3), dtype=np.int64)
    sizes = {loops.shape[1]} if isinstance(loops, np.ndarray) else set(map(len, loops))
    if min(sizes) < 3:
        raise ValueError("a face has fewer than three corners")
    flat = np.concatenate(loops, dtype=np.int64, casting="unsafe")
    if flat.min() < 0 or flat.max() >= len(vertices):
        raise ValueError(f"a face names a vertex that does not exist; there are {len(vertices)}")
    if sizes == {3}:
        return flat.reshape(-1, 3)
    return np.concatenate([_cut(vertices, np.asarray(loop, dtype=np.int64)) for loop in loops])


def _cut(vertices: FloatArray, loop: IntArray) -> IntArray:
    corners = vertices[loop] - vertices[loop].mean(axis=0)
    fan = np.column_stack([np.full(len(loop) - 2, loop[0]), loop[1:-1], loop[2:]])
    if len(loop) == 3:
        return fan
    turns = np.cross(corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners)
    normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    if not np.isfinite(normal).all() or (turns @ normal >= 0.0).all():
        return fan
    keep = np.delete(np.arange(3), int(np.argmax(np.abs(normal))))
    plane = np.ascontiguousarray(corners[:, keep])
    cut = mapbox_earcut.triangulate_float64(plane, np.array([len(loop)], dtype=np.uint32))
    pieces = loop[cut.astype(np.int64).reshape(-1, 3)]
    sense = np.cross(
        vertices[pieces[:, 1]] - vertices[pieces[:, 0]], vertices[pieces[:, 2]] - vertices[pieces[:, 0]]
    )
    return pieces if (sense @ normal).sum() > 0.0 else pieces[:, ::-1]
