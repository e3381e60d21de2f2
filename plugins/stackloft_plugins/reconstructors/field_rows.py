r"""Sections of any topology as rows of a field that is smooth where pieces end, part and meet.

::

        f = d·q          d: signed distance, q = 2m + c·d − (1 + c)·m·d/r    (d ≥ 0 on its own side)

On a disc of radius r standing alone q = 2r − d, so that f = r² − ρ²: a ball's rows are then one quadratic in
space, through its poles. r is the radius of the largest disc that touches the nearest boundary point from the
own side; m that of the smaller of both sides' (a limb's, or the gap's before two limbs merge), so that f goes
to zero linearly where the distance itself has a square root; c ≤ 1 is less at the tips of slender sections.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from stackloft.geometry.polygon_distance import signed_distance
from stackloft.geometry.tangent_discs import tangent_disc_curvatures
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack, Section
from stackloft.sectioning.dense_loops import dense_loops

_MARGIN = 3
"""Grid steps around all sections."""
_SOFT = 6.0
"""Exponent of the soft minimum of both sides' radii."""
_LEAST = 1.5
"""Grid steps: no radius counts as smaller."""
_NEAR = 2.0
"""Grid steps: nearer points of the same run of boundary say nothing of its radius."""
_AROUND = 2.0
"""A radius is compared with others within so many times theirs."""


@dataclass(frozen=True, slots=True, eq=False)
class FieldRows:
    """Sections on one grid, ordered along z (either way)."""

    z: FloatArray
    """(k,) mm"""
    distance: FloatArray
    """(k, rows, columns) mm, positive inside"""
    factor: FloatArray
    """(k, rows, columns) mm: q, positive"""
    radius: FloatArray
    """(k, rows, columns) mm: m of the nearest boundary point"""
    step: float
    """mm"""
    corner: FloatArray
    """(2,) mm: (x, y) of node (0, 0)"""

    @property
    def field(self) -> FloatArray:
        """Return f, (k, rows, columns) mm²."""
        return self.distance * self.factor


def field_rows(contours: ContourStack, count: int) -> FieldRows:
    """Return all sections on a grid with `count` steps across the largest one."""
    spans = [np.ptp(np.concatenate([loop.points for loop in s.loops]), axis=0) for s in contours.sections]
    step = float(np.max(spans)) / count
    points = np.concatenate([loop.points for s in contours.sections for loop in s.loops])
    low, high = points.min(axis=0) - _MARGIN * step, points.max(axis=0) + _MARGIN * step
    x, y = (low[k] + step * np.arange(math.ceil((high[k] - low[k]) / step) + 1) for k in (0, 1))
    polygons = dense_loops(contours, 0.5 * step)
    rows = [
        _row((x, y), section, loops, step) for section, loops in zip(contours.sections, polygons, strict=True)
    ]
    distance, factor, radius = (np.array([row[k] for row in rows]) for k in range(3))
    return FieldRows(contours.positions, distance, factor, radius, step, low)


def _row(
    grid: tuple[FloatArray, FloatArray], section: Section, polygons: list[FloatArray], step: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return distance, factor and radius of one section."""
    x, y = grid
    distance = signed_distance(x, y, polygons)
    points, inner, outer, radius, growth = _boundary(section, polygons, step)
    nodes = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    nearest = cKDTree(points).query(nodes)[1].reshape(distance.shape)
    own = np.where(distance > 0.0, inner[nearest], outer[nearest])
    m, c, d = radius[nearest], growth[nearest], np.abs(distance)
    return distance, 2.0 * m + c * d - (1.0 + c) * m * np.minimum(d * own, 1.0), m


def _boundary(
    section: Section, polygons: list[FloatArray], step: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return points along the boundary, both sides' disc curvatures, m and c at each."""
    pieces, normals = [], []
    for loop, polygon in zip(section.loops, polygons, strict=True):
        polygon = _from_its_corner(polygon)  # noqa: PLW2901
        along = np.roll(polygon, -1, axis=0) - np.roll(polygon, 1, axis=0)
        kept = _spread(polygon, step)
        unit = along[kept] / np.maximum(np.linalg.norm(along[kept], axis=1), 1e-300)[:, None]
        pieces.append(polygon[kept])
        normals.append((-1.0 if loop.hole else 1.0) * np.column_stack([-unit[:, 1], unit[:, 0]]))
    points, inward = np.concatenate(pieces), np.concatenate(normals)
    inner = np.maximum(tangent_disc_curvatures(points, inward, _NEAR * step), 1e-6)
    outer = np.maximum(tangent_disc_curvatures(points, -inward, _NEAR * step), 1e-6)
    radius = np.maximum((inner**_SOFT + outer**_SOFT) ** (-1.0 / _SOFT), _LEAST * step)
    apart = np.hypot(*(points[:, None, :] - points[None, :, :]).transpose(2, 0, 1))
    largest = np.where(apart < _AROUND * radius, radius, 0.0).max(axis=1)
    return points, inner, outer, radius, (radius / np.maximum(largest, radius)) ** 2


def _from_its_corner(polygon: FloatArray) -> FloatArray:
    """Return the polygon counter-clockwise from its lowest vertex: nothing depends on how it was given."""
    x, y = polygon.T
    if float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) < 0.0:
        polygon = polygon[::-1]
    return np.roll(polygon, -int(np.lexsort(polygon.T)[0]), axis=0)


def _spread(polygon: FloatArray, step: float) -> FloatArray:
    """Return which of a polygon's vertices to look at, about a step apart."""
    gaps = np.hypot(*np.diff(polygon, axis=0, append=polygon[:1]).T)
    passed = np.concatenate([[0.0], np.cumsum(gaps[:-1])])
    kept = np.diff(np.floor(passed / step), prepend=-1.0) > 0.0
    if np.count_nonzero(kept) < 8:
        kept[:] = True
    return np.asarray(kept)
