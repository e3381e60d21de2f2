"""From a slice's field to its closed loops, in millimetres.

Lines are followed between the pixels (`marching_squares`), put where the boundary is to a hundredth
of a pixel (`sub_pixel`), and sorted: debris is dropped, glare and seeds are filled, and what matters
is said in a notice.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.contour_stack import Loop
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField
from stackloft.sectioning.border_chains import chain_lines
from stackloft.sectioning.marching_squares import Crossings, closed_lines
from stackloft.sectioning.nesting import inside_polygon
from stackloft.sectioning.sub_pixel import REACH, crossing_points
from stackloft.sectioning.trace_notices import SIDES, border_notice, dropped_notice, filled_notice


@dataclass(frozen=True, slots=True)
class TraceRules:
    """What is kept of a slice. Fractions are of the area of its largest object."""

    debris: float = 0.02
    """Other objects below this are dropped without a word (crumbs, drops, dust)."""
    branch: float = 0.20
    """Other objects above this are kept as outlines of their own: the body branches there."""
    hole: float = 0.02
    """Holes below this are filled (glare, seeds)."""
    background_like: float = 0.5
    """A hole is real when it is at least this far from the level towards the background's grey: through a
    real hole the plate is seen, whereas fat or bone may only be nearer to it than the rest."""
    unnoticed_hole: float = 0.001
    """Holes filled below this together are not worth a notice."""
    fewest_pixels: float = 9.0
    """px²: an object smaller than this is no body."""


@dataclass(frozen=True, slots=True, eq=False)
class TracedLoops:
    """The loops of one slice and what a person should know about them."""

    loops: tuple[Loop, ...]
    """Outlines with positive, holes with negative signed area; the largest outline first."""
    notices: tuple[Notice, ...] = ()
    perhaps: tuple[tuple[Loop, Notice], ...] = ()
    """Outlines too small to be the body's by themselves, each with what is to be said when it is left out."""
    at_border: tuple[bool, ...] = ()
    """For each loop, whether it touches the picture's edge."""


def trace_field(
    section: SectionField,
    spacing: tuple[float, float],
    shape: tuple[int, int],
    name: str,
    rules: TraceRules | None = None,
) -> TracedLoops:
    """Return the loops on which a slice's field equals its level.

    Parameters
    ----------
    section : SectionField
        Body above the level.
    spacing : tuple of float
        (row, column) spacing, mm.
    shape : tuple of int
        (rows, columns) of the whole slice, to tell its border from that of the crop.
    name : str
        File or slice label, for messages.
    rules : TraceRules, optional
        What is debris, branch and hole.

    Returns
    -------
    TracedLoops
        Vertices (x, y) = (column·column spacing, row·row spacing) mm, about one per pixel; pixel (0, 0)'s
        centre is the origin.

    Raises
    ------
    InputError
        Nothing in the slice is above the level.

    Examples
    --------
    >>> values = np.full((40, 40), 20.0)
    >>> values[10:30, 10:30] = 100.0
    >>> loop = trace_field(SectionField(values, 60.0), (0.5, 0.5), (40, 40), "a").loops[0]
    >>> round(loop.signed_area, 1)                  # the corners are rounded off by the pixels
    99.9
    """
    rules = rules or TraceRules()
    grid = _quick_grid(section) or _bordered_grid(section)
    kept, dropped = _objects(grid.lines, rules, name)
    real, filled = _holes(kept, grid, rules)
    loops = tuple(_loop(line, grid, spacing) for line in (*kept, *real))
    perhaps = tuple(
        (_loop(line, grid, spacing), dropped_notice(line.area / kept[0].area, name))
        for line in dropped
        if not _inside_any(line, kept)  # what lies in a hole that is filled is filled with it
    )
    sides = [_sides(line, grid, shape) for line in (*kept, *real)]
    notices = (
        *filled_notice(-sum(hole.area for hole in filled) / kept[0].area, rules.unnoticed_hole, name),
        *border_notice({side for touched in sides for side in touched}, name),
    )
    return TracedLoops(loops, notices, perhaps, tuple(bool(touched) for touched in sides))


class _Line:
    """A closed line and its rough area in pixels, negative for a hole."""

    __slots__ = ("area", "crossings", "rough")

    def __init__(self, crossings: Crossings) -> None:
        self.crossings = crossings
        x = crossings.column + np.where(crossings.down, 0.0, 0.5)
        y = crossings.row + np.where(crossings.down, 0.5, 0.0)
        self.rough: FloatArray = np.column_stack([x, y])
        self.area = Loop(self.rough).signed_area


@dataclass(frozen=True, slots=True, eq=False)
class _Grid:
    """A slice's field and the lines in it."""

    field: NDArray[Any]
    """(rows, columns), of any real dtype"""
    level: float
    first: tuple[int, int]
    """(row, column) of the field's first pixel in the slice."""
    lines: list[_Line]


def _quick_grid(section: SectionField) -> _Grid | None:
    """Return the section's own field with its outlines; None where it needs a closer look."""
    if section.local_levels is not None:
        return None
    lines = chain_lines(section.above().view(np.uint8), REACH)
    if lines is None:
        return None
    return _Grid(section.values, section.level, section.offset, [_Line(crossings) for crossings in lines])


def _bordered_grid(section: SectionField) -> _Grid:
    field = _bordered(section)
    lines = [_Line(crossings) for crossings in closed_lines(field > 0, field)]
    return _Grid(field, 0.0, (section.offset[0] - REACH, section.offset[1] - REACH), lines)


def _bordered(section: SectionField) -> FloatArray:
    """Return the field above its level inside a border that no body reaches.

    The border mirrors the outermost pixels' values to the other side of the level, so that a body cut by
    the picture's edge is closed on that edge.
    """
    field: FloatArray = np.pad(section.relative(), REACH, mode="edge")
    for edge in (field[:REACH], field[-REACH:], field[:, :REACH], field[:, -REACH:]):
        np.copyto(edge, -np.abs(edge))
    return field


def _objects(lines: list[_Line], rules: TraceRules, name: str) -> tuple[list[_Line], list[_Line]]:
    """Return the outlines that are kept, largest first, and those whose loss deserves a notice."""
    outlines = sorted((line for line in lines if line.area > 0), key=lambda line: -line.area)
    largest = outlines[0].area if outlines else 0.0
    if largest < rules.fewest_pixels:
        raise InputError(
            "no body found",
            where=name,
            found=f"nothing larger than {largest:.0f} pixels",
            fix="give --set segmenter.threshold=LEVEL, or set skip = true for it in stack.toml",
        )
    kept = [line for line in outlines if line.area >= rules.branch * largest]
    return kept, [line for line in outlines if rules.debris * largest <= line.area < rules.branch * largest]


def _holes(kept: list[_Line], grid: _Grid, rules: TraceRules) -> tuple[list[_Line], list[_Line]]:
    """Return the holes of the kept outlines through which the background shows: real ones, filled ones."""
    holes = [line for line in grid.lines if line.area < 0]
    if not holes:
        return [], []
    field = grid.field
    starts = np.array([hole.rough[0] for hole in holes])
    within = np.any([inside_polygon(starts, outline.rough) for outline in kept], axis=0)
    own = [hole for hole, ours in zip(holes, within, strict=True) if ours]
    clear = rules.background_like * _background(field)
    notable = [hole for hole in own if -hole.area >= 0.1 * rules.unnoticed_hole * kept[0].area]
    through = [hole for hole in notable if _median_within(hole, field) <= clear]
    real = [hole for hole in through if -hole.area >= rules.hole * kept[0].area]
    return real, [hole for hole in through if hole not in real]


def _inside_any(line: _Line, outlines: list[_Line]) -> bool:
    """Return whether a line lies inside one of the outlines."""
    return any(inside_polygon(line.rough[:1], outline.rough)[0] for outline in outlines)


def _background(field: FloatArray) -> float:
    """Return the field's usual value along the frame of the crop, where it is background."""
    frame = np.concatenate([field[0], field[-1], field[:, 0], field[:, -1]])
    return float(np.median(frame))


def _median_within(hole: _Line, field: FloatArray) -> float:
    """Return the median of the field over the pixels of a hole."""
    low, high = hole.rough.min(axis=0).astype(int), hole.rough.max(axis=0).astype(int) + 1
    covered = np.zeros((high - low + 1)[::-1], dtype=np.uint8)
    cv2.fillPoly(covered, [np.round(hole.rough - low).astype(np.int32)], 1)
    window = field[low[1] : high[1] + 1, low[0] : high[0] + 1]
    return float(np.median(window[(covered > 0) & (window <= 0)]))


def _sides(line: _Line, grid: _Grid, shape: tuple[int, int]) -> list[str]:
    """Return the picture's edges that a line runs along: it is closed between them and the last pixels."""
    at = line.rough + np.array(grid.first[::-1])
    (left, top), (right, bottom) = at.min(axis=0), at.max(axis=0)
    rows, columns = shape
    found = {"top": top < 0, "bottom": bottom > rows - 1, "left": left < 0, "right": right > columns - 1}
    return [side for side in SIDES if found[side]]


def _loop(line: _Line, grid: _Grid, spacing: tuple[float, float]) -> Loop:
    """Return the line as a loop in mm."""
    pixels = crossing_points(line.crossings, grid.field, grid.level) + np.array(grid.first[::-1])
    points = pixels * np.array(spacing)[::-1]
    apart = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1) > 1e-9 * max(spacing)
    return Loop(frozen_floats(points[apart]), hole=line.area < 0)
