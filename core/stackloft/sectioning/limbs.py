"""Small outlines and holes that are the body's: a limb's tip, told from a crumb by the slices beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from stackloft.model.contour_stack import Loop, Section
from stackloft.model.notices import Notice
from stackloft.sectioning.loop_links import BELONG
from stackloft.sectioning.section_regions import overlap


def with_limbs(
    sections: Sequence[Section], perhaps: Sequence[Sequence[tuple[Loop, Notice]]]
) -> tuple[list[Section], list[Notice]]:
    """Return the sections with the small outlines that lie over or under the body's, and notices of the rest.

    Parameters
    ----------
    sections : sequence of Section
        With the outlines that are the body's for sure.
    perhaps : sequence of sequences of (Loop, Notice)
        For each section, small outlines and holes, and what is to be said when they are left out.

    Notes
    -----
    An outline (a hole) that overlaps one of the body's on a neighbouring section by `BELONG` of the smaller
    is part of it, and may in turn carry the next one.
    """
    found = list(sections)
    waiting = [(k, loop, notice) for k, loops in enumerate(perhaps) for loop, notice in loops]
    while True:
        taken = [item for item in waiting if _carried(found, *item[:2])]
        if not taken:
            return found, [notice for _, _, notice in waiting]
        for k, loop, _ in taken:
            found[k] = replace(found[k], loops=(*found[k].loops, loop))
        waiting = [item for item in waiting if item not in taken]


def _carried(sections: list[Section], k: int, loop: Loop) -> bool:
    """Return whether an outline lies over or under one of a neighbouring section."""
    beside = [sections[i] for i in (k - 1, k + 1) if 0 <= i < len(sections)]
    return any(
        overlap([loop.points], [other.points]) >= BELONG
        for section in beside
        for other in section.loops
        if other.hole == loop.hole
    )
