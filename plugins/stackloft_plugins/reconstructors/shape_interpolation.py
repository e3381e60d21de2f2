"""Shape interpolation: signed distances of the sections, cubic between them, and the zero surface."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise, starmap
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.geometry.meridian import cubic_across
from stackloft.geometry.polygon_distance import inside_grid, signed_distance
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, frozen_ints
from stackloft.model.bias import Bias
from stackloft.model.contour_stack import ContourStack
from stackloft.model.ends import End
from stackloft.model.lengths import parse_length
from stackloft.model.notices import Notice
from stackloft.model.tri_mesh import TriMesh
from stackloft.sectioning.dense_loops import dense_loops
from stackloft.sectioning.ends import PlannedEnd, StackEnds, plan_ends
from stackloft_plugins.reconstructors.distance_rows import (
    DistanceRows,
    SectionShapes,
    distance_rows,
    section_shapes,
)
from stackloft_plugins.reconstructors.field_rows import FieldRows, field_rows
from stackloft_plugins.reconstructors.flying_edges import zero_surface
from stackloft_plugins.reconstructors.piece_ends import LONG, closing_areas
from stackloft_plugins.reconstructors.pieces import Sight
from stackloft_plugins.reconstructors.topology_surface import topology_surface

_COARSE = 48
"""Grid steps across a loop that tell whether it is compact."""
_WHY = "where the body ends was guessed: give --height or --ends"


@dataclass(frozen=True)
class ShapeInterpolation:
    """Raya & Udupa (1990), IEEE Trans. Med. Imaging 9:32; Herman, Zheng & Bucholtz (1992), IEEE CG&A 12:69.

    Each section's signed distance on a grid, a cubic across sections, and the surface where it is zero. No
    points correspond and no loops are linked, hence none can be linked wrongly; ends are decided as the
    loft's are. Unlike the originals, sections of one compact loop each are interpolated about their own
    centres along the mean meridian's arc length, so that slanting bodies do not thin out and round ends come
    out round. Rings, holes, cavities, limbs and several pieces are interpolated by a field that is quadratic
    where the distance has a kink or a square root (`field_rows`); what ends between two sections is carried
    on from its own rows, and rings close over their ridge. Errs where thin parts of neighbouring sections do
    not overlap, and rounds edges by a grid step.
    """

    grid: int = option(96, "grid steps across the largest section", unit="px", ge=16, le=512)
    ends: str | None = option(
        None, "how the body ends, FIRST[,LAST]: auto, face, flat:LEN, round[:LEN], point[:LEN]"
    )
    height: float | None = option(None, "the body's whole length along the axis", unit="mm", gt=0)

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (ContourStack,)
    produces: ClassVar[tuple[type, ...]] = (TriMesh,)

    def reconstruct(self, product: ContourStack) -> TriMesh:
        """Return the closed surface in bench millimetres.

        Raises
        ------
        InputError
            Fewer than two sections, a section without the body, or ends and height that contradict each
            other.
        """
        shapes = section_shapes(product)
        fields = None if _one_loop_each(product) else field_rows(product, self.grid)
        said = End.parse_pair(self.ends) if self.ends is not None else product.hints.ends or (End(), End())
        height = product.hints.height if self.height is None else parse_length(self.height, "--height")
        ends = _planned(product, shapes, fields, said, height)
        if fields is None:
            vertices, faces = _surface(distance_rows(product, shapes, ends, self.grid))
        else:
            vertices, faces = topology_surface(fields, ends)
        placed = vertices @ product.affine[:3, :3].T + product.affine[:3, 3]
        if np.linalg.det(product.affine[:3, :3]) < 0.0:
            faces = faces[:, ::-1]
        unsure = _end_share(shapes, ends)
        return TriMesh(
            frozen_floats(placed),
            frozen_ints(faces),
            volume_bias=Bias(-1.5 - unsure, 1.0 + unsure, _WHY) if unsure else None,
            area_bias=Bias(-2.0 - unsure, 1.5 + unsure, _WHY) if unsure else None,
            notices=_guessed(ends),
        )


def _one_loop_each(contours: ContourStack) -> bool:
    """Return whether every section is one compact loop without a hole, above a part of the one before."""
    if any(len(section.loops) != 1 for section in contours.sections):
        return False
    spans = [float(np.ptp(section.loops[0].points, axis=0).max()) for section in contours.sections]
    polygons = [loops[0] for loops in dense_loops(contours, min(spans) / _COARSE)]
    return all(map(_compact, polygons)) and all(starmap(_overlap, pairwise(polygons)))


def _coarse_grid(polygon: FloatArray) -> tuple[FloatArray, FloatArray]:
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    return np.linspace(low[0], high[0], _COARSE), np.linspace(low[1], high[1], _COARSE)


def _compact(polygon: FloatArray) -> bool:
    """Return whether the largest disc that fits is not too small a part of the area."""
    x, y = polygon.T
    area = 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
    widest = float(signed_distance(*_coarse_grid(polygon), [polygon]).max())
    return area < LONG * math.pi * widest**2


def _overlap(first: FloatArray, second: FloatArray) -> bool:
    grid = _coarse_grid(first)
    within = [inside_grid(*grid, polygon, np.roll(polygon, -1, axis=0)) for polygon in (first, second)]
    return bool((within[0] & within[1]).any())


def _planned(
    contours: ContourStack,
    shapes: SectionShapes,
    fields: FieldRows | None,
    said: tuple[End, End],
    height: float | None,
) -> tuple[PlannedEnd, PlannedEnd]:
    """Return both ends, each guessed from areas that tell it: the sections', or a piece's own."""
    first = last = shapes.areas
    if fields is not None:
        sight = Sight(fields.field, fields.distance, fields.z, fields.step)
        first = closing_areas(sight, shapes.areas)
        last = closing_areas(sight.flipped(), shapes.areas[::-1])[::-1]
    where = contours.positions, contours.kind, contours.thickness
    plans = [
        plan_ends(StackEnds(where[0], areas, where[1], where[2]), said, height) for areas in (first, last)
    ]
    return plans[0][0], plans[1][1]


def _surface(rows: DistanceRows) -> tuple[FloatArray, IntArray]:
    """Return vertices (stack mm) and faces of the zero surface of the interpolated distance."""
    step = rows.grid[1] - rows.grid[0]
    nodes = rows.meridian.nodes
    parts = [max(1, math.ceil(length / step)) for length in np.diff(nodes)]
    arcs = np.concatenate(
        [a + (b - a) * np.arange(n) / n for a, b, n in zip(nodes[:-1], nodes[1:], parts, strict=True)]
        + [nodes[-1:]]
    )
    fields = cubic_across(nodes, rows.fields, rows.slopes)(arcs).astype(np.float32)
    lids = [-np.abs(fields[end])[None] for end in (0, -1)]
    points, faces = zero_surface(np.concatenate([lids[0], fields, lids[1]]))
    # beyond the end rows nothing is left: the lids' vertices fall back onto the plane face or the pole
    z = rows.meridian.z(np.interp(points[:, 2] - 1.0, np.arange(len(arcs)), arcs))
    centres = cubic_across(rows.z, rows.centres, (None, None))(z)
    plane = rows.grid[0] + step * points[:, :2] + centres
    return np.column_stack([plane, z]), faces


def _end_share(shapes: SectionShapes, ends: tuple[PlannedEnd, PlannedEnd]) -> float:
    """Return how much of the volume guessed ends may add or take, %: half their spread in length × area."""
    spreads = [end.extremes[1].length - end.extremes[0].length if end.guessed else 0.0 for end in ends]
    caps = 0.5 * np.array(spreads) * shapes.areas[[0, -1]]
    return 100.0 * float(caps.sum() / np.trapezoid(shapes.areas, shapes.z))


def _guessed(ends: tuple[PlannedEnd, PlannedEnd]) -> tuple[Notice, ...]:
    return tuple(
        Notice(
            "end-guessed",
            f"shape-interpolation: the {which} end's position was guessed ({end.kind.value},"
            f" {end.length:.2f} mm beyond the {which} section: {end.reason}): give --height or --ends",
        )
        for which, end in zip(("first", "last"), ends, strict=True)
        if end.guessed
    )
