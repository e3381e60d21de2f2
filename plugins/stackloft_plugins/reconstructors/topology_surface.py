"""The closed surface through sections of any topology: rows and ends, layers between, zero surface."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from stackloft.geometry.hermite_rows import HermiteRows
from stackloft.model.arrays import FloatArray, IntArray
from stackloft.sectioning.ends import PlannedEnd
from stackloft_plugins.reconstructors.field_rows import FieldRows
from stackloft_plugins.reconstructors.flying_edges import zero_surface
from stackloft_plugins.reconstructors.piece_ends import end_row
from stackloft_plugins.reconstructors.pieces import Sight, carried_on

_BULGE = (4.0, 1.5)
"""By how much the field, over gap², and the distance, over gap, may leave the straight line between rows."""
_BLEND = (0.4, 0.8)
"""Distance over radius: the distance is interpolated below the first, the field above the second."""
_LEVELS = (0.05, 0.005)
"""Bends of field (mm²/mm²) and distance (mm/mm²) that count alike."""


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    """Sections, what carries pieces on, and the ends' rows."""

    z: FloatArray
    field: FloatArray
    distance: FloatArray
    factor: FloatArray
    radius: FloatArray


def topology_surface(sections: FieldRows, ends: tuple[PlannedEnd, PlannedEnd]) -> tuple[FloatArray, IntArray]:
    """Return vertices (stack mm) and faces of the closed surface through sections of any topology.

    Parameters
    ----------
    sections : FieldRows
    ends : pair of PlannedEnd
        First and last.
    """
    rows = _with_ends(sections, ends)
    layers, z = _layers(rows, sections.step)
    layers[:, [0, -1], :] = -sections.step
    layers[:, :, [0, -1]] = -sections.step
    lids = [-np.abs(layers[end])[None] for end in (0, -1)]
    points, faces = zero_surface(np.concatenate([lids[0], layers, lids[1]]))
    # beyond the end rows nothing is left: the lids' vertices fall back onto the face, the pole or the ridge
    height = np.interp(points[:, 2] - 1.0, np.arange(len(z)), z)
    vertices = np.column_stack([sections.corner + sections.step * points[:, :2], height])
    return _through_sections(vertices, faces, sections.z)


def _with_ends(sections: FieldRows, ends: tuple[PlannedEnd, PlannedEnd]) -> _Rows:
    sight = Sight(sections.field, sections.distance, sections.z, sections.step)
    field = carried_on(sight)
    told = field == sight.field
    z, extra = [sections.z], [field]
    before = ends[0].length > 0.0
    if before:
        z.insert(0, sections.z[:1] - ends[0].length)
        extra.insert(0, end_row(sight, ends[0])[None])
    if ends[1].length > 0.0:
        z.append(sections.z[-1:] + ends[1].length)
        extra.append(end_row(sight.flipped(), ends[1])[None])
    whole = np.concatenate(extra)
    within = slice(int(before), int(before) + len(sections.z))
    # where rows hold no section their scale is that of the field itself: r² − ρ² at r = 0 is ρ·ρ
    factor = np.maximum(np.sqrt(np.abs(whole)), 0.5 * sections.step)
    radius = np.full(whole.shape, 0.01 * sections.step)
    factor[within] = np.where(told, sections.factor, factor[within])
    radius[within] = np.where(told, sections.radius, radius[within])
    return _Rows(np.concatenate(z), whole, whole / factor, factor, radius)


def _layers(rows: _Rows, step: float) -> tuple[NDArray[np.float32], FloatArray]:
    """Return distances on layers about a step apart and the layers' positions."""
    fields = HermiteRows(rows.z, rows.field, _LEVELS[0])
    distances = HermiteRows(rows.z, rows.distance, _LEVELS[1])
    near = np.abs(rows.distance) / rows.radius
    layers, z = [], []
    for i, gap in enumerate(np.diff(rows.z)):
        share = np.clip((np.maximum(near[i], near[i + 1]) - _BLEND[0]) / (_BLEND[1] - _BLEND[0]), 0.0, 1.0)
        share = share**2 * (3.0 - 2.0 * share)
        parts = max(2, math.ceil(gap / step))
        for t in np.arange(parts) / parts:
            z.append(rows.z[i] + t * gap)
            factor = (1.0 - t) * rows.factor[i] + t * rows.factor[i + 1]
            bulges = np.array([_BULGE[0] * gap**2, _BULGE[1] * gap]) * t * (1.0 - t)
            by_field = _bounded(fields, z[-1], (i, t), bulges[0]) / factor
            by_distance = _bounded(distances, z[-1], (i, t), bulges[1])
            layers.append((share * by_field + (1.0 - share) * by_distance).astype(np.float32))
    layers.append(rows.distance[-1].astype(np.float32))
    return np.array(layers), np.append(z, rows.z[-1])


def _bounded(rows: HermiteRows, at: float, place: tuple[int, float], bulge: float) -> FloatArray:
    """Return the interpolated row at most `bulge` off the straight line between its neighbours."""
    i, t = place
    line = (1.0 - t) * rows.values[i] + t * rows.values[i + 1]
    return np.asarray(np.clip(rows(at), line - bulge, line + bulge))


def _through_sections(
    vertices: FloatArray, faces: IntArray, sections: FloatArray
) -> tuple[FloatArray, IntArray]:
    """Return the surface less closed sheets that no section cuts: nothing speaks for them."""
    if not len(faces):
        return vertices, faces
    n = len(vertices)
    sides = np.concatenate([faces[:, :2], faces[:, 1:]])
    links = coo_array((np.ones(len(sides)), (sides[:, 0], sides[:, 1])), shape=(n, n))
    count, sheet = connected_components(links, directed=False)
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, sheet, vertices[:, 2])
    np.maximum.at(high, sheet, vertices[:, 2])
    cut = np.searchsorted(sections, low) < np.searchsorted(sections, high, side="right")
    kept = np.zeros(n, dtype=bool)
    kept[faces.ravel()] = True
    kept &= cut[sheet]
    place = np.cumsum(kept) - 1
    return vertices[kept], place[faces[kept[faces[:, 0]]]]
