"""Shape interpolation: signed distances of the sections, cubic between them, and the zero surface."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.geometry.meridian import cubic_across
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, frozen_ints
from stackloft.model.bias import Bias
from stackloft.model.contour_stack import ContourStack
from stackloft.model.ends import End
from stackloft.model.lengths import parse_length
from stackloft.model.notices import Notice
from stackloft.model.tri_mesh import TriMesh
from stackloft.sectioning.ends import PlannedEnd, StackEnds, plan_ends
from stackloft_plugins.reconstructors.distance_rows import (
    DistanceRows,
    SectionShapes,
    distance_rows,
    section_shapes,
)
from stackloft_plugins.reconstructors.flying_edges import zero_surface

_WHY = "where the body ends was guessed: give --height or --ends"


@dataclass(frozen=True)
class ShapeInterpolation:
    """Raya & Udupa (1990), IEEE Trans. Med. Imaging 9:32; Herman, Zheng & Bucholtz (1992), IEEE CG&A 12:69.

    Each section's signed distance on a grid, a cubic spline across sections, and the surface where it is
    zero. Unlike the originals, distances are taken about each section's own centre, so that slanting bodies
    do not thin out between sections, and the spline runs along the mean meridian's arc length, so that
    round ends come out round; ends are decided as the loft's are. No points correspond, hence none can
    correspond wrongly, and holes are carried along. Assumes one body whose sections change shape gradually;
    errs low where thin parts of neighbouring sections do not overlap, and rounds edges by a grid step.
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
        said = End.parse_pair(self.ends) if self.ends is not None else product.hints.ends or (End(), End())
        height = product.hints.height if self.height is None else parse_length(self.height, "--height")
        stack = StackEnds(product.positions, shapes.areas, product.kind, product.thickness)
        ends = plan_ends(stack, said, height)
        rows = distance_rows(product, shapes, ends, self.grid)
        vertices, faces = _surface(rows)
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
