r"""A section with a hole filled with triangles, fine at both rims and coarser between.

::

      o--o--o--o     rings between the rims, each of fewer points than the one before by `growth`, begun from
     /_o____o__\     both sides; a ring's points lie on straight lines from rim to rim, between points of the
    o-/ o--o \--o    same part of the way round. Where such triangles turn over (a hole far from the middle, a
    | |(    )| |     bent section) points of a lattice take their place, joined after Delaunay
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.disc_mesh import THICK, Disc, lattice_filled, signed_areas, stitched
from stackloft.geometry.shoelace import polygon_area, polygon_perimeter

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class BandPattern:
    """Triangles between two closed loops, whatever their shape."""

    places: FloatArray
    """(k, 2) part of the way across and round; those of the outer rim first, then those of the inner"""
    triangles: IntArray
    """(t, 3) counter-clockwise when the rims run so"""


def band_pattern(
    counts: tuple[int, int], lengths: tuple[float, float], width: float, growth: float
) -> BandPattern:
    """Return the rings between an outer and an inner loop.

    Parameters
    ----------
    counts : pair of int
        Points of the outer and the inner rim.
    lengths : pair of float
        Of the two rims, mm.
    width : float
        From rim to rim, mm.
    growth : float
        Edges become so much longer from ring to ring, from both rims.

    Examples
    --------
    >>> thin = band_pattern((12, 12), (12.0, 11.0), 0.5, 2.0)
    >>> len(thin.places), len(thin.triangles)
    (24, 24)
    """
    rings = _rings(counts, lengths, width, growth)
    order = [0, len(rings) - 1, *range(1, len(rings) - 1)]
    first = {}
    start = 0
    for k in order:
        first[k] = start
        start += rings[k][1]
    round_about = [np.arange(n) / n for _, n in rings]
    triangles: list[tuple[int, int, int]] = []
    for k in range(len(rings) - 1):
        triangles += stitched(round_about[k], round_about[k + 1], first[k], first[k + 1])
    places = [np.column_stack([np.full(rings[k][1], rings[k][0]), round_about[k]]) for k in order]
    return BandPattern(np.concatenate(places), np.array(triangles))


def _rings(
    counts: tuple[int, int], lengths: tuple[float, float], width: float, growth: float
) -> list[tuple[float, int]]:
    """Return part of the way across and points of each ring, rims included."""
    sides = [[(0.0, counts[0])], [(1.0, counts[1])]]
    edges = [lengths[0] / counts[0], lengths[1] / counts[1]]
    while True:
        k = int(edges[1] < edges[0])
        step = THICK * edges[k] * np.sqrt(growth) / width
        if sides[1][-1][0] - sides[0][-1][0] < 1.5 * step:
            return [*sides[0], *reversed(sides[1])]
        across = sides[k][-1][0] + (-step if k else step)
        edges[k] *= growth
        wanted = (lengths[0] + across * (lengths[1] - lengths[0])) / edges[k]
        sides[k].append((across, max(3, min(sides[k][-1][1], round(wanted)))))


def ring_filled(outer: FloatArray, inner: FloatArray, growth: float) -> Disc | None:
    """Return triangles between two simple polygons, or None when no good ones are found.

    Parameters
    ----------
    outer : (n, 2) array
        Counter-clockwise, mm.
    inner : (m, 2) array
        Within the outer one, clockwise, as a hole runs.
    growth : float
        As for `band_pattern`.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(24) / 24
    >>> circle = np.column_stack([np.cos(t), np.sin(t)])
    >>> disc = ring_filled(5 * circle, 2 * circle[::-1], 1.5)
    >>> disc.boundary, bool((signed_areas(disc.points, disc.triangles) > 0).all())
    (48, True)
    """
    n, m = len(outer), len(inner)
    shift = _shift(outer, inner[::-1])
    way = (m - 1 - np.arange(m) - shift) % m  # inner points counter-clockwise, abreast of the outer ones
    pattern = band_pattern(
        (n, m), (polygon_perimeter(outer), polygon_perimeter(inner)), ring_width(outer, inner), growth
    )
    across, part = pattern.places.T[:, :, None]
    points = (1.0 - across) * _at(outer, part[:, 0]) + across * _at(inner[way], part[:, 0])
    points[n : n + m] = inner
    place = np.arange(len(points))
    place[n : n + m] = n + way
    triangles = place[pattern.triangles]
    if (signed_areas(points, triangles) > 0.0).all():
        return Disc(points, triangles, n + m)
    return lattice_filled([outer, inner], growth)


def ring_width(outer: FloatArray, inner: FloatArray) -> float:
    """Return the mean distance between two rims, mm: the area between them over their mean length."""
    area = abs(polygon_area(outer)) - abs(polygon_area(inner))
    return 2.0 * area / (polygon_perimeter(outer) + polygon_perimeter(inner))


def _shift(outer: FloatArray, inner: FloatArray) -> int:
    """Return how many points later the inner loop starts abreast of the outer one."""
    m = len(inner)
    abreast = _at(outer, np.arange(m) / m)
    apart = [((abreast - np.roll(inner, -k, axis=0)) ** 2).sum() for k in range(m)]
    return int(np.argmin(apart))


def _at(loop: FloatArray, part: FloatArray) -> FloatArray:
    """Return points on a loop by the part of its points passed."""
    closed = np.vstack([loop, loop[:1]])
    places = np.asarray(part) % 1.0 * len(loop)
    return np.column_stack([np.interp(places, np.arange(len(loop) + 1), closed[:, k]) for k in (0, 1)])
