"""Loops of one photograph alone: reflections at the picture's edge, and on the flesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from stackloft.model.contour_stack import Loop, Section
from stackloft.model.notices import Notice
from stackloft.sectioning.section_regions import overlap

GLARE = 0.06
"""Of a section's largest outline: a smaller hole is a reflection's when no neighbour has it."""
LAMP = (0.02, 0.25)
"""Of the stack's largest outline, but no more than so much of the section's own: likewise, for a lamp's
mirror image is as large on a body's tip as on its middle."""
_INSIDE = 0.98
"""Of a hole that lies within the body of a neighbouring section."""


def without_strays(
    sections: Sequence[Section], at_border: Sequence[Sequence[bool]]
) -> tuple[list[Section], list[Notice]]:
    """Return the sections without what neither neighbour shows, and what is to be said of it.

    Parameters
    ----------
    sections : sequence of Section
    at_border : sequence of sequences of bool
        For each section, which of its first loops touch the picture's edge; loops beyond do not.

    Notes
    -----
    An outline at the picture's edge that lies over and under nothing, where another outline of the same
    section
    does, is no part of the body. A small hole that lies within the body on all neighbouring sections is
    closed.
    """
    kept, notices = list(sections), []
    lamp = LAMP[0] * max((_largest(section) for section in sections if section.loops), default=0.0)
    for k, (section, touching) in enumerate(zip(sections, at_border, strict=True)):
        beside = [sections[i] for i in (k - 1, k + 1) if 0 <= i < len(sections)]
        stray = [
            loop for loop, touches in zip(section.loops, touching, strict=False) if touches and not loop.hole
        ]
        stray = [loop for loop in stray if not _carried(loop, beside)]
        if stray and any(_carried(loop, beside) for loop in section.loops if not loop.hole):
            loops = tuple(loop for loop in section.loops if loop not in stray)
            notices.append(_at_the_edge(stray, loops, section.name))
            kept[k] = replace(section, loops=loops)
        glare = [loop for loop in kept[k].loops if loop.hole and _closed(loop, kept[k], beside, lamp)]
        if glare:
            kept[k] = replace(kept[k], loops=tuple(loop for loop in kept[k].loops if loop not in glare))
            notices.append(_filled(glare, kept[k]))
    return kept, notices


def _carried(loop: Loop, beside: Sequence[Section]) -> bool:
    """Return whether an outline lies over or under any outline of the sections beside."""
    return any(
        overlap([loop.points], [other.points]) > 0
        for section in beside
        for other in section.loops
        if not other.hole
    )


def _closed(hole: Loop, section: Section, beside: Sequence[Section], lamp: float) -> bool:
    """Return whether a hole is no larger than a reflection, and flesh in all sections beside."""
    own = _largest(section)
    if not beside or abs(hole.signed_area) > max(GLARE * own, min(lamp, LAMP[1] * own)):
        return False
    return all(overlap([hole.points], [loop.points for loop in other.loops]) >= _INSIDE for other in beside)


def _largest(section: Section) -> float:
    return max(abs(loop.signed_area) for loop in section.loops)


def _at_the_edge(stray: Sequence[Loop], body: Sequence[Loop], name: str) -> Notice:
    share = sum(abs(loop.signed_area) for loop in stray) / max(abs(loop.signed_area) for loop in body)
    message = (
        f"{name}: left out what lies at the picture's edge ({100 * share:.1f} % of the body's area) and on "
        "no neighbouring slice: a reflection, or something beside the plate; give a mask in stack.toml if it "
        "belongs to the body"
    )
    return Notice("edge-object", message)


def _filled(glare: Sequence[Loop], section: Section) -> Notice:
    share = sum(abs(hole.signed_area) for hole in glare) / _largest(section)
    message = (
        f"{section.name}: filled holes of {100 * share:.2g} % of the body's area that no neighbouring slice "
        "has, taken for glare"
    )
    return Notice("hole-filled", message)
