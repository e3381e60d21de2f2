"""Slices' fields traced, several at once: sections with their corners, and all that goes with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import islice

from stackloft.model.arrays import frozen_floats
from stackloft.model.contour_stack import Loop, Section
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import SliceStack
from stackloft.sectioning.slice_lines import SliceToTrace, TraceRules
from stackloft.sectioning.smoothing import smooth_loops
from stackloft.sectioning.tracing import trace_fields
from stackloft.sectioning.turning_loops import with_all_corners


@dataclass(frozen=True, slots=True, eq=False)
class TracedSlice:
    """What one slice gave."""

    section: Section
    perhaps: list[tuple[Loop, Notice]]
    notices: tuple[Notice, ...]
    at_border: tuple[bool, ...]
    """For each loop, whether it touches the picture's edge."""
    smooth: Mapping[Loop, Loop]
    """Each loop of the section as every further step needs it."""


def traced_slices(
    some: list[tuple[int, SliceToTrace]], stack: SliceStack, rules: TraceRules
) -> list[TracedSlice]:
    """Return the sections of some slices, corners and all."""
    found = trace_fields([one for _, one in some], rules)
    placed = [
        [_placed(loop, stack, k) for loop in own.loops] for (k, _), own in zip(some, found, strict=True)
    ]
    pixels = [max(one.spacing) for (_, one), loops in zip(some, placed, strict=True) for _ in loops]
    cornered = with_all_corners([loop for loops in placed for loop in loops], pixels)
    smooth = dict(zip(cornered, smooth_loops(cornered, float(stack.pixel_spacing.max())), strict=True))
    loops = iter(cornered)
    sections = [
        Section(float(stack.positions[k]), tuple(islice(loops, len(own.loops))), one.name)
        for (k, one), own in zip(some, found, strict=True)
    ]
    return [
        TracedSlice(
            section,
            [(_placed(loop, stack, k), notice) for loop, notice in own.perhaps],
            (*one.section.notices, *own.notices),
            own.at_border,
            {loop: smooth[loop] for loop in section.loops},
        )
        for (k, one), own, section in zip(some, found, sections, strict=True)
    ]


def _placed(loop: Loop, stack: SliceStack, index: int) -> Loop:
    """Return the loop where it lies in the stack's plane coordinates."""
    if stack.origins is None and stack.turns is None:
        return loop
    return replace(loop, points=frozen_floats(stack.placed(index, loop.points)))
