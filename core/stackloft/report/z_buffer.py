"""Triangles drawn with numpy alone: no display, no graphics library that may crash without one.

Large triangles are split, so that the rectangle around each holds few pixels beside those within it; then the
pixels of many rectangles are looked at together, and of those inside, the nearest surface wins.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, IntArray

SMALL = 16.0
"""Pixels that a triangle may reach across before it is split."""
AT_ONCE = 2_000_000
"""Pixels looked at together."""
CREASE = 0.8
"""Where a triangle's normal and its vertex's mean one have a smaller cosine, the surface is not smooth."""


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """What is seen at every pixel."""

    normals: NDArray[np.float32]
    """(rows, columns, 3) unit vectors (right, down, away)"""
    depth: NDArray[np.float32]
    """(rows, columns) pixels away from the viewer; infinite where nothing is seen"""

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Where there is a surface."""
        found: NDArray[np.bool_] = np.isfinite(self.depth)
        return found


def draw_triangles(points: FloatArray, faces: IntArray, size: tuple[int, int]) -> Drawn:
    """Return the visible side of a closed surface.

    Parameters
    ----------
    points : (n, 3) array
        (right, down, away) in pixels; the first pixel's centre is at (0.5, 0.5).
    faces : (t, 3) array
        Counter-clockwise seen from outside in space.
    size : tuple of int
        (columns, rows).

    Examples
    --------
    >>> square = np.array([[1.0, 1, 0], [1, 3, 0], [3, 3, 0], [3, 1, 0]])
    >>> drawn = draw_triangles(square, np.array([[0, 3, 2], [0, 2, 1]])[:, ::-1], (4, 4))
    >>> int(drawn.seen.sum()), drawn.normals[1, 1].tolist()
    (4, [0.0, 0.0, -1.0])
    """
    normals = corner_normals(points, faces)
    facing = normals.mean(axis=1)[:, 2] < 0.25  # a crease's faces have normals of their own
    corners, normals = _split(points[faces[facing]], normals[facing])
    columns, rows = size
    depth = np.full(rows * columns, np.inf, dtype=np.float32)
    seen = np.zeros((rows * columns, 3), dtype=np.float32)
    for at, away, normal in _fragments(corners, normals, columns, rows):
        nearer = np.flatnonzero(away < depth[at])
        order = nearer[np.argsort(-away[nearer], kind="stable")]
        depth[at[order]] = away[order]
        seen[at[order]] = normal[order]
    length = np.linalg.norm(seen, axis=1, keepdims=True)
    seen /= np.where(length > 0, length, 1)
    return Drawn(seen.reshape(rows, columns, 3), depth.reshape(rows, columns))


def corner_normals(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return (t, 3, 3) outward unit normals of each triangle's corners: smooth, but flat along creases."""
    corner = points[faces]
    flat = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    vertex = np.zeros_like(points)
    for k in range(3):
        for axis in range(3):
            vertex[:, axis] += np.bincount(faces[:, k], flat[:, axis], minlength=len(points))
    flat, vertex = _unit(flat), _unit(vertex)
    least = np.ones(len(points))
    for k in range(3):
        np.minimum.at(least, faces[:, k], (vertex[faces[:, k]] * flat).sum(axis=1))
    smooth = (least > CREASE)[faces][:, :, None]
    return np.where(smooth, vertex[faces], flat[:, None])


def _unit(vectors: FloatArray) -> FloatArray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1.0)


def _split(corners: FloatArray, normals: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return triangles that each reach across at most `SMALL` pixels."""
    done: list[tuple[FloatArray, FloatArray]] = []
    while len(corners):
        reach = np.ptp(corners[:, :, :2], axis=1).max(axis=1)
        small = reach <= SMALL
        done.append((corners[small], normals[small]))
        corners, normals = _quartered(corners[~small]), _quartered(normals[~small])
    return np.concatenate([x for x, _ in done]), np.concatenate([x for _, x in done])


def _quartered(corners: FloatArray) -> FloatArray:
    a, b, c = corners.swapaxes(0, 1)
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    parts = [np.stack(part, axis=1) for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return np.concatenate(parts)


Fragments = tuple[IntArray, NDArray[np.float32], NDArray[np.float32]]
"""Pixel index, depth and normal."""


def _fragments(corners: FloatArray, normals: FloatArray, columns: int, rows: int) -> Iterator[Fragments]:
    """Yield everything inside of a triangle, some triangles at a time."""
    flat = corners[:, :, :2]
    first = np.floor(np.clip(flat.min(axis=1), 0, (columns, rows))).astype(np.int64)
    last = np.ceil(np.clip(flat.max(axis=1), 0, (columns, rows))).astype(np.int64)
    sides = np.maximum(last - first, 0)
    pixels = np.cumsum(sides.prod(axis=1))
    cuts = np.searchsorted(pixels, np.arange(0, pixels[-1] if len(pixels) else 0, AT_ONCE))
    for start, stop in itertools.pairwise([*np.unique(cuts).tolist(), len(corners)]):
        some = slice(start, stop)
        yield _inside(corners[some], normals[some], first[some], sides[some], columns)


def _inside(
    corners: FloatArray, normals: FloatArray, first: IntArray, sides: IntArray, columns: int
) -> Fragments:
    """Return the pixels of the rectangles at `first` that lie in their triangles."""
    counts = sides.prod(axis=1)
    which = np.repeat(np.arange(len(corners)), counts)
    number = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    down, right = np.divmod(number, np.maximum(sides[which, 0], 1))
    px, py = first[which, 0] + right, first[which, 1] + down
    (ax, ay), (bx, by), (cx, cy) = (corners[:, k, :2].T for k in range(3))
    twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    scale = np.where(np.abs(twice) > 1e-12, 1.0 / np.where(twice == 0, 1.0, twice), np.nan)
    x, y = px + 0.5 - ax[which], py + 0.5 - ay[which]
    v = (x * ((cy - ay) * scale)[which]) - y * ((cx - ax) * scale)[which]
    w = y * ((bx - ax) * scale)[which] - x * ((by - ay) * scale)[which]
    inside = np.flatnonzero((v >= -1e-9) & (w >= -1e-9) & (v + w <= 1 + 1e-9))
    which, v, w = which[inside], v[inside], w[inside]
    weight = np.stack([1.0 - v - w, v, w], axis=1)
    away = (weight * corners[which, :, 2]).sum(axis=1).astype(np.float32)
    normal = np.einsum("fk,fkx->fx", weight, normals[which]).astype(np.float32)
    return py[inside] * columns + px[inside], away, normal
