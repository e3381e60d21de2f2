r"""Levels between two sections where a body parts along a whole line at once: a lying tube's bore, a groove.

::

     ( )   ( )     the parted section
     (  ) (  )     gaps put in: half the width is the given gap's times the cosine of a turn,
     (   )(   )    its depth as half the width's square falls to zero over the parted sections
     (   ||   )    the line, where the piece is cut
     (        )    the section in one piece

What `sections_between` finds where a bridge narrows to a point has no answer here: the bridge keeps its
length and loses its height. The gap closes as a roof does over its ridge, seen from the other side.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.end_model import distance_to_end
from stackloft.geometry.polygon_distance import signed_distance
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.levels import Level, is_hole, put_in_level, reversed_loop
from stackloft.sectioning.roof import TURNS, Thickness, closing_depth
from stackloft.sectioning.sections_between import SIDES, evened_loop, grid_lines, plane_grid

CLOSING = 4.0
"""Radius, in half widths of the gap, of the disc that closes it: its ends dip in by an eighth of a width."""
LONGEST = 0.98
"""The line lies at most this fraction of the pitch from the parted section."""
REFINED = 3
ZOOM = 4.0


@dataclass(frozen=True, slots=True, eq=False)
class Parting:
    """One piece on one section, several on the next, and the sections beyond these."""

    whole: Level
    """The loop that parts, alone"""
    parted: Level
    """What it parts into"""
    beyond: tuple[Level, ...]
    """The parted section and those after it, away from the whole one, all their loops"""


def parting_levels(parting: Parting) -> list[Level]:
    """Return the levels put in, from the whole section to the parted one; empty when no gap is found.

    The first is in one piece and lies where the gap closes.
    """
    hollow = is_hole(parting.whole.polygons[0])
    outline = [p[::-1] if hollow else p for p in parting.whole.polygons]
    thickness = _gap_thickness(parting, outline, hollow=hollow)
    if thickness is None:
        return []
    pitch = abs(parting.parted.z - parting.whole.z)
    root = distance_to_end(thickness.half**2, thickness.depth) if len(thickness.half) > 1 else None
    length = root if root is not None and root < LONGEST * pitch else 0.5 * pitch
    parts = [p[::-1] if hollow else p for p in parting.parted.polygons]
    planes = _Planes(outline, parts, float(thickness.half[0]))
    levels = []
    for turn in (*TURNS, 0.5 * np.pi):
        depth = closing_depth(float(np.cos(turn)), thickness, length)
        loops = planes.at(depth / pitch, float(np.cos(turn)))
        wanted = len(parts) if turn < 0.5 * np.pi else len(outline)
        if len(loops) != wanted:
            return []
        z = parting.parted.z + np.sign(parting.whole.z - parting.parted.z) * depth
        turned = [reversed_loop(loop) if hollow else loop for loop in loops]
        name = f"between {parting.whole.name} and {parting.parted.name}"
        levels.append(put_in_level(float(z), turned, name))
    return levels[::-1]


class _Planes:
    """The piece on one grid: whole, parted, and parted with its gap closed."""

    def __init__(self, outline: list[FloatArray], parts: list[FloatArray], half: float) -> None:
        self.x, self.y = plane_grid([*outline, *parts])
        radius = CLOSING * half
        reach = int(np.ceil(radius / (self.x[1] - self.x[0]))) + 2
        wide_x, wide_y = (_longer(axis, reach) for axis in (self.x, self.y))
        grown = grid_lines(signed_distance(wide_x, wide_y, parts) + radius, wide_x, wide_y)
        self.half = half
        self.whole = signed_distance(self.x, self.y, outline)
        self.parts = signed_distance(self.x, self.y, parts)
        self.closed = np.maximum(signed_distance(self.x, self.y, grown) - radius, self.parts)

    def at(self, t: float, width: float) -> list[Loop]:
        """Return the loops a fraction t of the way to the whole section, the gap's width times `width`."""
        around = (1.0 - t) * self.closed + t * self.whole
        field = np.minimum(around, self.parts + (1.0 - width) * self.half) if width > 1e-9 else around
        step = float(self.x[1] - self.x[0])
        return [evened_loop(line, step, SIDES) for line in grid_lines(field, self.x, self.y)]


def _longer(axis: FloatArray, reach: int) -> FloatArray:
    step = axis[1] - axis[0]
    return np.asarray(axis[0] + step * np.arange(-reach, len(axis) + reach))


def _gap_thickness(parting: Parting, outline: list[FloatArray], *, hollow: bool) -> Thickness | None:
    """Return half the gap's width on the parted section and up to two beyond it."""
    half, depth = [], []
    count = None
    for level in parting.beyond[:3]:
        loops = [p for p in level.polygons if is_hole(p) == hollow]
        if count is not None and len(loops) != count:
            break
        count = len(loops)
        width = _inscribed(outline, loops)
        if width <= 0.0:
            break
        half.append(width)
        depth.append(abs(level.z - parting.parted.z))
    return Thickness(np.array(half), np.array(depth)) if half else None


def _inscribed(outline: list[FloatArray], loops: list[FloatArray]) -> float:
    """Return the radius of the largest circle inside the outline that holds nothing of the loops."""
    x, y = plane_grid(outline)
    best = 0.0
    for _ in range(REFINED):
        inside = signed_distance(x, y, outline)
        outside = -signed_distance(x, y, loops)
        free = np.minimum(inside, outside)
        row, column = np.unravel_index(int(np.argmax(free)), free.shape)
        best = float(free[row, column])
        step = x[1] - x[0]
        x, y = (at + np.arange(-ZOOM, ZOOM + 1) * step / ZOOM for at in (x[column], y[row]))
    return best
