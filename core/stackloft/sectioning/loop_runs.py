"""Runs of loops that go on one to one from section to section: what the overview colours alike."""

from __future__ import annotations

from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import ContourStack, Section
from stackloft.model.errors import InputError
from stackloft.sectioning.loop_links import LinkedLoops, components, link_loops
from stackloft.sectioning.loop_numbers import numbered_links
from stackloft.sectioning.section_regions import Regions, section_regions


def loop_runs(contours: ContourStack) -> list[list[int]]:
    """Return the number of the run, from 0, that each loop of each section belongs to.

    A run begins where a loop appears, and where loops part or meet. Empty when the loops cannot be linked.

    Examples
    --------
    >>> import numpy as np
    >>> from stackloft.model.contour_stack import Loop
    >>> square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    >>> whole, left, right = Loop(square * [3, 1]), Loop(square - [2, 0]), Loop(square + [2, 0])
    >>> loops = [(whole,), (whole,), (left, right), (left, right)]
    >>> loop_runs(ContourStack(tuple(Section(float(z), own, str(z)) for z, own in enumerate(loops))))
    [[0], [0], [1, 2], [1, 2]]
    """
    try:
        return _runs(contours)
    except InputError:  # crossing loops: whoever lofts them says so
        return []


def _runs(contours: ContourStack) -> list[list[int]]:
    count = 0
    runs: list[list[int]] = []
    regions = [section_regions([loop.points for loop in s.loops], s.name) for s in contours.sections]
    for k, own in enumerate(regions):
        numbers = [-1] * len(own.loops)
        if k:
            for linked in _linked(contours, k - 1, regions):
                if linked.plain:
                    numbers[linked.after[0]] = runs[-1][linked.before[0]]
        for i, number in enumerate(numbers):
            if number < 0:
                numbers[i], count = count, count + 1
        runs.append(numbers)
    return runs


def _linked(contours: ContourStack, k: int, regions: list[Regions]) -> list[LinkedLoops]:
    before, after = contours.sections[k], contours.sections[k + 1]
    said = contours.hints.links.get(before.name)
    if said is None:
        return link_loops(regions[k], regions[k + 1])
    loops = [_turned(section, own) for section, own in zip((before, after), regions[k : k + 2], strict=True)]
    pairs = numbered_links(said, loops[0], loops[1], (before.name, after.name))
    return components(pairs, regions[k], regions[k + 1], set())


def _turned(section: Section, regions: Regions) -> list[FloatArray]:
    """Return the polygons, holes clockwise."""
    return [
        p if (polygon_area(p) < 0.0) == bool(hole) else p[::-1]
        for p, hole in zip((loop.points for loop in section.loops), regions.holes, strict=True)
    ]
