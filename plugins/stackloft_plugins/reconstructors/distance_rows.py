r"""The rows that shape interpolation goes through: each section's signed distance, and what closes the ends.

::

    pole      section 1       section 2    …    every row on the same grid, about its own centre;
     .          (   )         (       )         a pole's distance is minus that from the point
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.meridian import Meridian, mean_meridian
from stackloft.geometry.polygon_distance import signed_distance
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack
from stackloft.model.ends import EndKind
from stackloft.model.errors import InputError
from stackloft.sectioning.dense_loops import dense_loops
from stackloft.sectioning.ends import PlannedEnd
from stackloft.sectioning.section_measures import measure_loops

_MARGIN = 3
"""Grid steps around the largest section."""


@dataclass(frozen=True, slots=True, eq=False)
class SectionShapes:
    """Sections about their own centres."""

    z: FloatArray
    """(m,) mm"""
    areas: FloatArray
    """(m,) mm²"""
    centres: FloatArray
    """(m, 2) mm: area centroids"""


@dataclass(frozen=True, slots=True, eq=False)
class DistanceRows:
    """Signed distances to be interpolated."""

    fields: FloatArray
    """(k, rows, columns) mm, positive inside"""
    z: FloatArray
    """(k,) mm"""
    centres: FloatArray
    """(k, 2) mm: where each row's grid is centred"""
    meridian: Meridian
    slopes: tuple[FloatArray | None, FloatArray | None]
    """d(distance)/d(arc length) at a round pole that is the first (last) row; None elsewhere."""
    grid: FloatArray
    """(n,) mm: the grid's coordinates about the centre, the same along x and y"""


def section_shapes(contours: ContourStack) -> SectionShapes:
    """Return areas and centres of all sections, holes subtracted.

    Raises
    ------
    InputError
        Fewer than two sections, or one without the body.
    """
    if len(contours) < 2:
        raise InputError("a solid needs at least 2 sections", found=str(len(contours)))
    loops = measure_loops(contours)
    m = len(contours)
    signed = loops.sign * loops.areas
    areas: FloatArray = np.bincount(loops.section, signed, minlength=m).astype(np.float64)
    for section, area in zip(contours.sections, areas, strict=True):
        if not area > 0.0:
            raise InputError("a section without the body", where=section.name, fix="leave it out")
    moments = [np.bincount(loops.section, signed * loops.centroids[:, k], minlength=m) for k in (0, 1)]
    return SectionShapes(contours.positions, areas, np.stack(moments, axis=1) / areas[:, None])


def distance_rows(
    contours: ContourStack, shapes: SectionShapes, ends: tuple[PlannedEnd, PlannedEnd], count: int
) -> DistanceRows:
    """Return the rows of a closed body on a grid with `count` steps across its largest section."""
    sparse = [np.concatenate([loop.points for loop in section.loops]) for section in contours.sections]
    half = max(float(np.abs(p - c).max()) for p, c in zip(sparse, shapes.centres, strict=True))
    step = 2.0 * half / count
    grid = step * (np.arange(count + 2 * _MARGIN + 1, dtype=np.float64) - (0.5 * count + _MARGIN))
    polygons = [
        [loop - centre for loop in loops]
        for loops, centre in zip(dense_loops(contours, 0.5 * step), shapes.centres, strict=True)
    ]
    fields = np.array([signed_distance(grid, grid, loops) for loops in polygons])
    first = _end_row(shapes, fields, grid, ends[0])
    last = _end_row(_reversed(shapes), fields[::-1], grid, ends[1])
    rows = [first, _Rows(shapes.z, shapes.areas, shapes.centres, fields), last]
    z = np.concatenate([row.z for row in rows])
    areas = np.concatenate([row.areas for row in rows])
    smooth = (ends[0].kind is EndKind.ROUND, ends[1].kind is EndKind.ROUND)
    slopes = (
        _pole_slope(polygons[0], shapes.areas[0], grid) if smooth[0] else None,
        -_pole_slope(polygons[-1], shapes.areas[-1], grid) if smooth[1] else None,
    )
    return DistanceRows(
        fields=np.concatenate([row.fields for row in rows]),
        z=z,
        centres=np.concatenate([row.centres for row in rows]),
        meridian=mean_meridian(z, np.sqrt(areas / np.pi), smooth),
        slopes=slopes,
        grid=grid,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    z: FloatArray
    areas: FloatArray
    centres: FloatArray
    fields: FloatArray


def _reversed(shapes: SectionShapes) -> SectionShapes:
    return SectionShapes(shapes.z[::-1], shapes.areas[::-1], shapes.centres[::-1])


def _end_row(shapes: SectionShapes, fields: FloatArray, grid: FloatArray, end: PlannedEnd) -> _Rows:
    """Return the row beyond the outermost section (the first given), or none for a face."""
    if end.length == 0.0:
        return _Rows(np.empty(0), np.empty(0), np.empty((0, 2)), fields[:0])
    depth = np.abs(shapes.z - shapes.z[0])
    outward = np.sign(shapes.z[0] - shapes.z[1])
    z = shapes.z[:1] + outward * end.length
    if end.kind is EndKind.FLAT:
        centre, field, area = shapes.centres[:1], fields[:1], shapes.areas[:1]
        grown = float(area[0] + (area[0] - shapes.areas[1]) * end.length / depth[1])
        if end.length <= depth[1] and 0.5 < grown / float(area[0]) < 2.0:
            centre = _continued(shapes.centres, depth, end.length, 2)
            field = _continued(fields, depth, end.length, 2)
            area = np.array([grown])
        return _Rows(z, area, centre, field)
    centre = _continued(shapes.centres, depth, end.length, 3)
    point = -np.hypot(grid[None, :], grid[:, None])[None]
    return _Rows(z, np.zeros(1), centre, point)


def _continued(values: FloatArray, depth: FloatArray, length: float, rows: int) -> FloatArray:
    """Return, (1, ...), the polynomial through the outermost `rows` rows at `length` beyond the first."""
    t = depth[: min(rows, len(depth))]
    weights = [np.prod([(-length - b) / (a - b) for b in t if b != a]) for a in t]
    return np.asarray(np.tensordot(weights, values[: len(t)], axes=1))[None]


def _pole_slope(polygons: list[FloatArray], area: float, grid: FloatArray) -> FloatArray:
    """Return how fast the distance grows along the meridian at a round pole, (rows, columns).

    A small section of the outermost section's shape, of mean radius ρ, is ρ·h(u)/r nearer than its centre
    in direction u, h being the support function of the section of mean radius r; along the arc dρ/dt = 1.
    """
    vertices = np.concatenate(polygons)
    angles = 2.0 * np.pi * np.arange(256) / 256
    support = (vertices @ np.stack([np.cos(angles), np.sin(angles)])).max(axis=0)
    own = np.arctan2(grid[:, None], grid[None, :])
    return np.asarray(np.interp(own, angles, support, period=2.0 * np.pi) / np.sqrt(area / np.pi))
