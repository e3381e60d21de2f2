r"""A section filled with triangles, fine at its boundary and coarser inside.

::

     o--o--o           rings shrunk towards the middle, each with fewer points by `growth`, joined by
    / \/ \/ \          triangles; where the section is not seen whole from its middle (a kidney, a C)
   o---o---o-o         points of a lattice instead, joined after Delaunay
    \ / \ / /
     o--o--o           every triangle has at most one edge on the boundary, corners apart
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, cKDTree

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

THICK = 0.9
"""Thickness of a ring over the mean of its edges: equal sides would need 0.87."""


@dataclass(frozen=True, slots=True, eq=False)
class Disc:
    """Triangles of a section; its boundary points come first, in their order."""

    points: FloatArray
    """(k, 2) mm"""
    triangles: IntArray
    """(t, 3) counter-clockwise"""
    boundary: int
    """How many points the boundary has."""


def filled(section: FloatArray, growth: float) -> Disc | None:
    """Return triangles inside a simple polygon, or None when no good ones are found.

    Parameters
    ----------
    section : (n, 2) array
        The boundary's points, counter-clockwise, mm; n ≥ 4.
    growth : float
        Edges from one ring to the next become this much longer; at least 1.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(24) / 24
    >>> disc = filled(np.column_stack([np.cos(t), np.sin(t)]), 1.5)
    >>> disc.boundary, bool((signed_areas(disc.points, disc.triangles) > 0).all())
    (24, True)
    """
    rings, triangles = ring_pattern(len(section), growth)
    middle = _centroid(section)
    disc = Disc(_shrunk(section, rings, middle), triangles, len(section))
    if (signed_areas(disc.points, triangles) > 0.0).all():
        return disc
    return lattice_filled([section], growth)


def ring_pattern(count: int, growth: float) -> tuple[FloatArray, IntArray]:
    """Return (k, 2) radius and place along the loop (0 to 1) of the points of rings, and their triangles.

    Examples
    --------
    >>> rings, triangles = ring_pattern(8, 2.0)
    >>> len(rings), len(triangles), float(rings[-1, 0])
    (13, 16, 0.0)
    """
    counts, radii = [count], [1.0]
    edge = 2.0 * np.pi / count
    while True:
        thickness = THICK * edge * np.sqrt(growth)
        inner = radii[-1] - thickness
        if inner < 0.45 * thickness:
            break
        edge = min(edge * growth, 2.0 * np.pi * inner / 3.0)
        counts.append(max(3, min(counts[-1], round(2.0 * np.pi * inner / edge))))
        radii.append(inner)
    if len(counts) == 1:
        counts.append(max(3, count // 2))
        radii.append(0.5)
    first = np.concatenate([[0], np.cumsum(counts)])
    rows = [np.column_stack([np.full(n, r), (np.arange(n) + 0.5 * (k > 0)) / n])
            for k, (n, r) in enumerate(zip(counts, radii, strict=True))]  # fmt: skip
    triangles = []
    for k in range(len(counts) - 1):
        triangles += stitched(rows[k][:, 1], rows[k + 1][:, 1], int(first[k]), int(first[k + 1]))
    last, n = int(first[-2]), counts[-1]
    triangles += [(last + j, last + (j + 1) % n, int(first[-1])) for j in range(n)]
    return np.vstack([*rows, [[0.0, 0.0]]]), np.array(triangles)


def stitched(outer: FloatArray, inner: FloatArray, a: int, b: int) -> list[tuple[int, int, int]]:
    """Return the triangles between two rings by their places along the loop, numbered from a and b."""
    n, m = len(outer), len(inner)
    start = int(np.argmin(np.abs((inner - outer[0] + 0.5) % 1.0 - 0.5)))
    offset = (inner[start] - outer[0] + 0.5) % 1.0 - 0.5
    steps = np.diff(inner[(start + np.arange(m + 1)) % m]) % 1.0
    along = offset + np.concatenate([[0.0], np.cumsum(steps)])
    result, i, j = [], 0, 0
    while i < n or j < m:
        next_outer = (i + 1) / n if i < n else np.inf
        next_inner = along[j + 1] if j < m else np.inf
        p, q = a + i % n, b + (start + j) % m
        if next_outer + i / n <= next_inner + along[j]:
            result.append((p, a + (i + 1) % n, q))
            i += 1
        else:
            result.append((p, b + (start + j + 1) % m, q))
            j += 1
    return result


def _shrunk(section: FloatArray, rings: FloatArray, middle: FloatArray) -> FloatArray:
    """Return the rings' points: the boundary's polygon, shrunk towards the middle."""
    n = len(section)
    closed = np.vstack([section, section[:1]])
    places = rings[:, 1] * n
    points = np.column_stack([np.interp(places, np.arange(n + 1), closed[:, axis]) for axis in range(2)])
    return np.asarray(middle + rings[:, :1] * (points - middle))


def lattice_filled(loops: list[FloatArray], growth: float) -> Disc | None:
    """Return Delaunay triangles over the rims and a lattice inside; None when they do not fit.

    Parameters
    ----------
    loops : list of (n, 2) arrays
        The outer rim counter-clockwise, holes clockwise, mm.
    growth : float
        The lattice is so much coarser than the rims, where that fits.
    """
    rims = np.vstack(loops)
    ends = np.vstack([np.roll(loop, -1, axis=0) for loop in loops])
    edge = np.linalg.norm(ends - rims, axis=1)
    for spacing in (growth * edge.mean(), edge.mean(), 0.7 * edge.mean()):
        inner = _lattice(rims, ends, spacing)
        points = np.vstack([rims, inner])
        cut = Delaunay(points).simplices.astype(np.int64)
        cut = np.where((signed_areas(points, cut) < 0.0)[:, None], cut[:, ::-1], cut)
        inside = _within(rims, ends, points[cut].mean(axis=1))
        triangles = cut[inside & (signed_areas(points, cut) > 1e-9 * spacing**2)]
        if _fits(triangles, [len(loop) for loop in loops], len(points)):
            return Disc(points, triangles, len(rims))
    return None


def _lattice(rims: FloatArray, ends: FloatArray, spacing: float) -> FloatArray:
    """Return the points of a triangular lattice inside the section, clear of its boundary."""
    low, high = rims.min(axis=0), rims.max(axis=0)
    rows = np.arange(low[1], high[1] + spacing, spacing * np.sqrt(0.75))
    columns = np.arange(low[0], high[0] + spacing, spacing)
    grid = np.array([(x + 0.5 * spacing * (k % 2), y) for k, y in enumerate(rows) for x in columns])
    dense = np.concatenate([rims + t * (ends - rims) for t in np.arange(4) / 4])
    clear = cKDTree(dense).query(grid)[0] > 0.55 * spacing
    return np.asarray(grid[clear & _within(rims, ends, grid)])


def _fits(triangles: IntArray, rims: list[int], count: int) -> bool:
    """Return whether the triangles fill the section: Euler's number, and every edge of the rims there."""
    boundary = sum(rims)
    if len(triangles) != 2 * count - boundary - 2 * (2 - len(rims)):
        return False
    own = {(int(a), int(b)) for t in triangles for a, b in zip(t, np.roll(t, -1), strict=True)}
    first = np.cumsum([0, *rims])
    sides = ((a + k, a + (k + 1) % n) for a, n in zip(first, rims, strict=False) for k in range(n))
    return all(side in own for side in sides)


def contains(section: FloatArray, points: FloatArray) -> BoolArray:
    """Return which points lie inside a polygon, by the even–odd rule.

    Examples
    --------
    >>> contains(np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]]), np.array([[1.0, 1], [3, 1]])).tolist()
    [True, False]
    """
    return _within(section, np.roll(section, -1, axis=0), points)


def _within(a: FloatArray, b: FloatArray, points: FloatArray) -> BoolArray:
    """Return which points lie inside the loops whose sides run from a to b, by the even–odd rule."""
    inside = np.zeros(len(points), dtype=bool)
    for (x0, y0), (x1, y1) in zip(a, b, strict=True):
        spans = (y0 > points[:, 1]) != (y1 > points[:, 1])
        if spans.any():
            cross = x0 + (points[:, 1] - y0) * (x1 - x0) / ((y1 - y0) or 1.0)
            inside ^= spans & (points[:, 0] < cross)
    return np.asarray(inside)


def signed_areas(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the triangles' areas, positive when counter-clockwise, (t,)."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.asarray(0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]))


def _centroid(section: FloatArray) -> FloatArray:
    origin = section.mean(axis=0)
    a = section - origin
    b = np.roll(a, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return np.asarray(origin + ((a + b) * cross[:, None]).sum(axis=0) / (3.0 * cross.sum()))
