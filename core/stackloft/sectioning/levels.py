"""The loops at one position along the axis, given or put in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.section_regions import section_regions


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """The loops at one position."""

    z: float
    """mm"""
    loops: tuple[Loop, ...]
    """outlines counter-clockwise, holes clockwise"""
    polygons: tuple[FloatArray, ...]
    """the same in short sides, same directions"""
    name: str
    section: int | None
    """Number of the section; None for one put in."""


def make_level(
    z: float, loops: list[Loop], polygons: list[FloatArray], name: str, section: int | None
) -> Level:
    """Return a level whose outlines run counter-clockwise and whose holes run clockwise.

    Raises
    ------
    InputError
        Loops cross.
    """
    regions = section_regions(polygons, name)
    turned = [
        (loop, p) if (polygon_area(p) < 0.0) == bool(hole) else (reversed_loop(loop), p[::-1])
        for loop, p, hole in zip(loops, polygons, regions.holes, strict=True)
    ]
    return Level(z, tuple(t[0] for t in turned), tuple(t[1] for t in turned), name, section)


def reversed_loop(loop: Loop) -> Loop:
    """Return the loop run the other way."""
    return Loop(loop.points[::-1], np.sort(len(loop.points) - 1 - loop.corners), loop.hole)


def is_hole(polygon: FloatArray) -> bool:
    """Return whether a level's polygon bounds a hole: it runs clockwise."""
    return polygon_area(polygon) < 0.0


def part_level(level: Level, chosen: tuple[int, ...]) -> Level:
    """Return the level with some of its loops alone."""
    return Level(
        level.z,
        tuple(level.loops[k] for k in chosen),
        tuple(level.polygons[k] for k in chosen),
        level.name,
        level.section,
    )


def covered(level: Level) -> float:
    """Return the area of a level's loops, holes subtracted, mm²."""
    return float(sum(polygon_area(p) for p in level.polygons))


def put_in_level(z: float, loops: list[Loop], name: str) -> Level:
    """Return a level of loops put in, body on the left."""
    return Level(z, tuple(loops), tuple(loop.points for loop in loops), name, None)


def loop_counts(level: Level) -> tuple[int, int]:
    """Return the numbers of outlines and of holes."""
    holes = sum(polygon_area(p) < 0.0 for p in level.polygons)
    return len(level.polygons) - holes, holes
