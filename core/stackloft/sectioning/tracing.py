"""From a slice's field to its closed loops, in millimetres.

Lines are followed between the pixels (`marching_squares`), put where the boundary is to a hundredth
of a pixel (`sub_pixel`), and sorted: debris is dropped, glare and seeds are filled, and what matters
is said in a notice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.contour_stack import Loop
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField
from stackloft.sectioning.single_outline import single_outlines
from stackloft.sectioning.slice_lines import Grid, Line, SliceToTrace, SortedLines, TraceRules, sorted_lines
from stackloft.sectioning.sub_pixel import LevelLine, points_of_lines
from stackloft.sectioning.trace_notices import SIDES, border_notice, dropped_notice, filled_notice


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
    return trace_fields([SliceToTrace(section, spacing, shape, name)], rules or TraceRules())[0]


def trace_fields(slices: Sequence[SliceToTrace], rules: TraceRules) -> list[TracedLoops]:
    """Return the loops of several slices, as `trace_field` does; together they take less time.

    Raises
    ------
    InputError
        A slice shows nothing above its level; the first such one is named.
    """
    quick = single_outlines(slices, rules)
    rest = iter(_sorted_fields([one for one, own in zip(slices, quick, strict=True) if own is None], rules))
    return [next(rest) if own is None else TracedLoops((Loop(own),), at_border=(False,)) for own in quick]


def _sorted_fields(slices: Sequence[SliceToTrace], rules: TraceRules) -> list[TracedLoops]:
    """Return the loops of slices by sorting all lines that there are."""
    sorted_out = [sorted_lines(one, rules) for one in slices]
    lines = [(line, one) for one in sorted_out for line in (*one.kept, *one.real, *one.perhaps)]
    points = points_of_lines(
        [LevelLine(line.crossings, one.grid.field, one.grid.level, one.grid.noise) for line, one in lines]
    )
    loops = iter(_loops(points, lines))
    return [_traced(one, loops, rules) for one in sorted_out]


def _traced(one: SortedLines, loops: Iterator[Loop], rules: TraceRules) -> TracedLoops:
    """Return a slice's loops, the next ones of all, with what is to be said of them."""
    name, whole = one.slice.name, one.kept[0].area
    body = tuple(islice(loops, len(one.kept) + len(one.real)))
    perhaps = tuple((next(loops), _left_out(line.area / whole, name)) for line in one.perhaps)
    sides = [_sides(line, one.grid, one.slice.shape) for line in (*one.kept, *one.real)]
    notices = (
        *filled_notice(-sum(hole.area for hole in one.filled) / whole, rules.unnoticed_hole, name),
        *border_notice({side for touched in sides for side in touched}, name),
    )
    return TracedLoops(body, notices, perhaps, tuple(bool(touched) for touched in sides))


def _left_out(share: float, name: str) -> Notice:
    """Return what to say of an outline (or a hole, negative) that no neighbouring slice carries on."""
    return dropped_notice(share, name) if share > 0.0 else next(filled_notice(-share, 0.0, name))


def _sides(line: Line, grid: Grid, shape: tuple[int, int]) -> list[str]:
    """Return the picture's edges that a line runs along: it is closed between them and the last pixels."""
    row, column = grid.first
    rows, columns = shape
    if (
        min(row, column) >= 0
        and row + grid.field.shape[0] <= rows
        and column + grid.field.shape[1] <= columns
    ):
        return []
    x, y = line.rough[:, 0], line.rough[:, 1]
    found = {
        "top": y.min() + row < 0,
        "bottom": y.max() + row > rows - 1,
        "left": x.min() + column < 0,
        "right": x.max() + column > columns - 1,
    }
    return [side for side in SIDES if found[side]]


def _loops(pixels: list[FloatArray], lines: Sequence[tuple[Line, SortedLines]]) -> list[Loop]:
    """Return the lines' points, (k, 2) column and row in their grids, as loops in mm."""
    if not pixels:
        return []
    counts = np.array([len(points) for points in pixels])
    starts = np.cumsum(counts) - counts
    spacing = np.array([one.slice.spacing for _, one in lines])
    points = np.concatenate(pixels)
    steps = np.empty((2, len(points)))
    for axis in (0, 1):  # a coordinate at a time: rows of two take several times as long
        place = points[:, axis]
        place += np.repeat([float(one.grid.first[1 - axis]) for _, one in lines], counts)
        place *= np.repeat(spacing[:, 1 - axis], counts)
        np.subtract(place[1:], place[:-1], out=steps[axis, 1:])
        steps[axis, starts] = place[starts] - place[starts + counts - 1]
    apart = np.abs(steps).max(axis=0) > np.repeat(1e-9 * spacing.max(axis=1), counts)
    kept = points if apart.all() else points[apart]
    cuts = np.cumsum(np.add.reduceat(apart, starts, dtype=np.int64))[:-1]
    return [
        Loop(frozen_floats(own), hole=line.area < 0)
        for own, (line, _) in zip(np.split(kept, cuts), lines, strict=True)
    ]
