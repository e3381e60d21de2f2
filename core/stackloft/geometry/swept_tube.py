r"""The vertices of a swept tube: layers through the sections, domed where an end is a pole.

::

        pole                     rims lie on the surface; inner points are carried from the largest layer by
       .-o-.                     mean values. Beneath a pole layers bulge towards the body's middle, so that
     o´--.--`o  rim              the elements under a flat cap are not flat: their middles are spread along
     |  `-´  |                   the axis as their rims are spread along the meridian
     o-------o
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.disc_mesh import Disc, filled
from stackloft.geometry.exact_surface import points_on
from stackloft.geometry.mean_value import carried
from stackloft.geometry.ring_mesh import ring_filled
from stackloft.geometry.swept_tets import swept

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class SweptTube:
    """Straight tetrahedra of a tube, and where on the tube its boundary vertices lie."""

    vertices: FloatArray
    """(n, 3) mm"""
    elements: IntArray
    """(m, 4) positive"""
    at: FloatArray
    """(n, 2) parameters (v, u) in patches of each vertex on the side; NaN inside. A pole has u = NaN."""
    skin: IntArray
    """(n,) the tube of patches that a vertex on the side lies on; -1 inside"""
    layer: int
    """Vertices of one layer; layers come one after the other, then the poles."""


def swept_tube(
    tubes: tuple[FloatArray, ...],
    rows: FloatArray,
    columns: tuple[FloatArray, ...],
    poles: tuple[bool, bool],
    growth: float,
) -> SweptTube | None:
    """Return the tetrahedra in a tube, or between two, or None when its sections cannot be filled.

    Parameters
    ----------
    tubes : one or two (rows, columns, 4, 4, 3) arrays
        Bézier control points, mm: the outer skin, then that of a hole, oriented into it.
    rows : (r,) array
        Stations along v, both ends among them.
    columns : a (c,) array for each tube
        Stations along u, 0 among them.
    poles : pair of bool
        Where the tube ends in a point; elsewhere in a plane face.
    growth : float
        How much longer edges become from one ring to the next inner one.
    """
    first, last = (int(pole) for pole in poles)
    levels = rows[first : len(rows) - last]
    rims = [
        tube_points(patches, np.repeat(levels, len(own)), np.tile(own, len(levels))).reshape(
            len(levels), len(own), 3
        )
        for patches, own in zip(tubes, columns, strict=True)
    ]
    disc = _disc(rims, growth)
    if disc is None:
        return None
    layers = carried(disc.points, disc.triangles, disc.boundary, np.concatenate(rims, axis=1))
    patches = tubes[0]
    tips = [patches[0, 0, 0, 0] if poles[0] else None, patches[-1, 0, 3, 0] if poles[1] else None]
    layers = domed(layers, disc, tips)
    vertices = np.concatenate([layers.reshape(-1, 3), *(tip[None] for tip in tips if tip is not None)])
    elements = swept(disc.triangles, len(disc.points), len(levels), poles)
    at = np.full((len(levels), len(disc.points), 2), np.nan)
    at[:, : disc.boundary, 0], at[:, : disc.boundary, 1] = levels[:, None], np.concatenate(columns)
    ends = [[rows[-k], np.nan] for k in (0, 1) if poles[k]]  # rows[0] and rows[-1]
    corners = vertices[elements]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
    if volumes.sum() < 0.0:
        elements = elements[:, [0, 2, 1, 3]]
    where = np.concatenate([at.reshape(-1, 2), np.array(ends).reshape(-1, 2)])
    skin = np.full(len(disc.points), -1)
    skin[: disc.boundary] = np.repeat(np.arange(len(tubes)), [len(own) for own in columns])
    skins = np.concatenate([np.tile(skin, len(levels)), np.zeros(len(ends), dtype=np.int64)])
    return SweptTube(vertices, elements, where, skins, len(disc.points))


def tube_points(patches: FloatArray, v: FloatArray, u: FloatArray) -> FloatArray:
    """Return the points of a tube at (v, u) in patches; u runs on round the loop."""
    rows, columns = patches.shape[:2]
    u = u % columns
    row = np.clip(np.floor(v).astype(np.int64), 0, rows - 1)
    column = np.minimum(np.floor(u).astype(np.int64), columns - 1)
    flat = patches.reshape(-1, 4, 4, 3)
    return points_on(flat, row * columns + column, v - row, u - column)


def _disc(rims: list[FloatArray], growth: float) -> Disc | None:
    """Return the triangles of the largest layer, in its own plane."""
    outer = rims[0]
    vectors = 0.5 * np.cross(outer, np.roll(outer, -1, axis=1)).sum(axis=1)
    areas = np.linalg.norm(vectors, axis=1)
    largest = int(np.argmax(areas))
    normal = vectors[largest] / areas[largest]
    across = np.eye(3)[int(np.argmin(np.abs(normal)))]
    x = np.cross(across, normal)
    x /= np.linalg.norm(x)
    plane = np.column_stack([x, np.cross(normal, x)])
    flat = [(rim[largest] - outer[largest].mean(axis=0)) @ plane for rim in rims]
    return filled(flat[0], growth) if len(flat) == 1 else ring_filled(flat[0], flat[1], growth)


def domed(layers: FloatArray, disc: Disc, tips: list[FloatArray | None]) -> FloatArray:
    """Return the layers with their middles spread along the axis as their rims are along the meridian."""
    if tips[0] is None and tips[1] is None:
        return layers
    rims = layers[:, : disc.boundary]
    middles = layers[:, -1]
    first = [tips[0]] if tips[0] is not None else []
    last = [tips[1]] if tips[1] is not None else []
    axis = np.array([*first, *middles, *last])
    around = np.concatenate([np.broadcast_to(tip, (1, *rims.shape[1:])) for tip in first] + [rims]
                            + [np.broadcast_to(tip, (1, *rims.shape[1:])) for tip in last])  # fmt: skip
    meridian = _cumulated(np.linalg.norm(np.diff(around, axis=0), axis=2).mean(axis=1))
    along = _cumulated(np.linalg.norm(np.diff(axis, axis=0), axis=1))
    wanted = np.column_stack([np.interp(meridian, along, axis[:, k]) for k in range(3)])
    shift = (wanted - axis)[len(first) : len(axis) - len(last)]
    return np.asarray(layers + _bulge(disc)[None, :, None] * shift[:, None])


def _cumulated(steps: FloatArray) -> FloatArray:
    total = np.concatenate([[0.0], np.cumsum(steps)])
    return np.asarray(total / total[-1])


def _bulge(disc: Disc) -> FloatArray:
    """Return 0 at the boundary, 1 deepest inside, rising like a parabola."""
    section = disc.points[: disc.boundary]
    dense = np.concatenate([section + t * (np.roll(section, -1, axis=0) - section) for t in np.arange(8) / 8])
    off = disc.points[disc.boundary :, None] - dense[None]
    depth = np.sqrt((off**2).sum(axis=2).min(axis=1))
    part = 1.0 - depth / depth.max()
    return np.concatenate([np.zeros(disc.boundary), 1.0 - part**2])
