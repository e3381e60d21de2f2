"""The closed lines of a slice's field, sorted: the body's outlines, its holes, and what is neither."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.noise_floor import NoiseFloor
from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.segmentation import SectionField
from stackloft.sectioning.border_chains import chain_lines, line_around, near_border
from stackloft.sectioning.large_masks import one_at_a_time
from stackloft.sectioning.marching_squares import Crossings, closed_lines
from stackloft.sectioning.nesting import inside_polygon
from stackloft.sectioning.sub_pixel import REACH


@dataclass(frozen=True, slots=True)
class TraceRules:
    """What is kept of a slice. Fractions are of the area of its largest object."""

    debris: float = 0.02
    """Other objects below this are dropped without a word (crumbs, drops, dust)."""
    branch: float = 0.20
    """Other objects above this are kept as outlines of their own: the body branches there."""
    hole: float = 0.02
    """Holes below this are filled (glare, seeds)."""
    hole_end: float = 0.002
    """Holes above this are kept where they lie over or under a hole of a neighbouring slice: its end."""
    background_like: float = 0.5
    """A hole is real when it is at least this far from the level towards the background's grey: through a
    real hole the plate is seen, whereas fat or bone may only be nearer to it than the rest."""
    unnoticed_hole: float = 0.001
    """Holes filled below this together are not worth a notice."""
    fewest_pixels: float = 9.0
    """px²: an object smaller than this is no body."""
    fewest_beside: float = 16.0
    """px²: another object smaller than this is dropped: too few vertices for a curve that can be joined."""


@dataclass(frozen=True, slots=True, eq=False)
class SliceToTrace:
    """A slice's field and what is known of the slice."""

    section: SectionField
    spacing: tuple[float, float]
    """(row, column) spacing, mm"""
    shape: tuple[int, int]
    """(rows, columns) of the whole slice, to tell its border from that of the crop."""
    name: str
    """File or slice label, for messages."""


class Line:
    """A closed line and its rough area in pixels, negative for a hole."""

    __slots__ = ("area", "crossings", "rough")

    def __init__(self, crossings: Crossings) -> None:
        self.crossings = crossings
        self.rough: FloatArray = np.empty((2, len(crossings.row))).T  # a coordinate's values side by side
        self.rough[:, 0] = crossings.column + 0.5 * ~crossings.down
        self.rough[:, 1] = crossings.row + 0.5 * crossings.down
        self.area = polygon_area(self.rough)


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """A slice's field and the lines in it."""

    field: NDArray[Any]
    """(rows, columns), of any real dtype"""
    level: float
    first: tuple[int, int]
    """(row, column) of the field's first pixel in the slice."""
    lines: list[Line]
    noise: NoiseFloor | None = None
    """What noise still adds to empty pixels of the field."""


@dataclass(frozen=True, slots=True, eq=False)
class SortedLines:
    """A slice's lines by what becomes of them."""

    slice: SliceToTrace
    grid: Grid
    kept: list[Line]
    """Outlines, the largest first."""
    real: list[Line]
    """Holes through which the background shows."""
    filled: list[Line]
    perhaps: list[Line]
    """Outlines and holes too small to be the body's by themselves."""


def sorted_lines(one: SliceToTrace, rules: TraceRules) -> SortedLines:
    """Return a slice's lines by what becomes of them.

    Raises
    ------
    InputError
        Nothing in the slice is above the level.
    """
    grid = _quick_grid(one.section) or _bordered_grid(one.section)
    kept, dropped = _objects(grid.lines, rules, one.name)
    real, filled = _holes(kept, grid, rules)
    # what lies in a hole that is filled is filled with it
    perhaps = [line for line in dropped if not _inside_any(line, kept)]
    ends = [hole for hole in filled if -hole.area >= rules.hole_end * kept[0].area]
    filled = [hole for hole in filled if hole not in ends]
    return SortedLines(one, grid, kept, real, filled, [*perhaps, *ends])


def _quick_grid(section: SectionField) -> Grid | None:
    """Return the section's own field with its outlines; None where it needs a closer look."""
    if section.local_levels is not None:
        return None
    chain = None if section.outline is None else section.outline - np.array(section.offset[::-1], np.int32)
    if chain is None or near_border(chain, section.values.shape, REACH):
        with one_at_a_time(section.values.size):
            lines = chain_lines(section.above().view(np.uint8), REACH)
    else:
        lines = [line_around(chain)]
    if lines is None:
        return None
    found = [Line(crossings) for crossings in lines]
    return Grid(section.values, section.level, section.offset, found, section.noise)


def _bordered_grid(section: SectionField) -> Grid:
    field = _bordered(section)
    lines = [Line(crossings) for crossings in closed_lines(field > 0, field)]
    return Grid(field, 0.0, (section.offset[0] - REACH, section.offset[1] - REACH), lines)


def _bordered(section: SectionField) -> FloatArray:
    """Return the field above its level inside a border that no body reaches.

    The border mirrors the outermost pixels' values to the other side of the level, so that a body cut by
    the picture's edge is closed on that edge.
    """
    field: FloatArray = np.pad(section.relative(), REACH, mode="edge")
    for edge in (field[:REACH], field[-REACH:], field[:, :REACH], field[:, -REACH:]):
        np.copyto(edge, -np.abs(edge))
    return field


def _objects(lines: list[Line], rules: TraceRules, name: str) -> tuple[list[Line], list[Line]]:
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
    least = max(rules.debris * largest, rules.fewest_beside)
    return kept, [line for line in outlines if least <= line.area < rules.branch * largest]


def _holes(kept: list[Line], grid: Grid, rules: TraceRules) -> tuple[list[Line], list[Line]]:
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


def _inside_any(line: Line, outlines: list[Line]) -> bool:
    """Return whether a line lies inside one of the outlines."""
    return any(inside_polygon(line.rough[:1], outline.rough)[0] for outline in outlines)


def _background(field: FloatArray) -> float:
    """Return the field's usual value along the frame of the crop, where it is background."""
    frame = np.concatenate([field[0], field[-1], field[:, 0], field[:, -1]])
    return float(np.median(frame))


def _median_within(hole: Line, field: FloatArray) -> float:
    """Return the median of the field over the pixels of a hole."""
    low, high = hole.rough.min(axis=0).astype(int), hole.rough.max(axis=0).astype(int) + 1
    covered = np.zeros((high - low + 1)[::-1], dtype=np.uint8)
    cv2.fillPoly(covered, [np.round(hole.rough - low).astype(np.int32)], 1)
    window = field[low[1] : high[1] + 1, low[0] : high[0] + 1]
    return float(np.median(window[(covered > 0) & (window <= 0)]))
