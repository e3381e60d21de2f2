"""What is told of links between sections that were chosen, or that are hardly known."""

from __future__ import annotations

import math

from stackloft.geometry.shoelace import polygon_area, polygon_perimeter
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.sectioning.levels import Level
from stackloft.sectioning.loop_links import LinkedLoops
from stackloft.sectioning.loop_numbers import by_size
from stackloft.sectioning.section_regions import overlap

SURE = 0.6
"""Part of a long loop that lies on the next one, at least, for the skin between them to be known: coils of
different pitch have 0.2 % of false area at 0.62 and 0.8 % or more at 0.56."""
LONG = 1.5
"""Perimeter² / (4π area) of a long loop; an ellipse of 3 : 1 has 1.5."""


def weak_notice(before: str, after: str, told: str = "loop 1 → 1") -> Notice:
    """Return what is told of loops that hardly overlap; `told` is the link in people's numbers."""
    return Notice(
        "weak-link",
        f"{before} to {after}: loops that overlap by less than 30 % of the smaller one were taken for one"
        f" part of the body ({told}): cut thinner slices, or say links in stack.toml",
    )


def apart_notice(before: Level, after: Level) -> Notice:
    """Return what is told of a part that ends where another begins."""
    return Notice(
        "part-lost",
        f"{before.name} to {after.name}: a part of the body ends and another begins between them, as their"
        " loops do not overlap; if it is one part that moves sideways, cut thinner slices or say links in"
        " stack.toml",
    )


def carried_far(one: FloatArray, two: FloatArray) -> bool:
    """Return whether a long loop shares little more than half of itself with the next one, (k, 2) mm each."""
    long = all(polygon_perimeter(p) ** 2 > LONG * 4.0 * math.pi * abs(polygon_area(p)) for p in (one, two))
    return long and overlap([one], [two]) < SURE


def turned_notice(before: str, after: str) -> Notice:
    """Return what is told of a bent part that is carried far round."""
    return Notice(
        "part-turns",
        f"{before} to {after}: a long part is carried so far that little more than half of it lies on itself:"
        " the skin between is an estimate, its area may be off by percents; cut thinner slices",
    )


def chosen_notice(before: Level, after: Level, choice: list[LinkedLoops]) -> Notice:
    """Return what is told where links were chosen among several."""
    told = "; ".join(link_numbers(before, after, linked) for linked in choice)
    return Notice(
        "ambiguous-link",
        f"{before.name} to {after.name}: the loops part and meet in more ways than one; taken: {told}:"
        " cut thinner slices, or say links in stack.toml",
    )


def link_numbers(before: Level, after: Level, linked: LinkedLoops) -> str:
    """Return a link in people's numbers: loops 1, 3 → 2."""
    numbers = [
        ", ".join(str(by_size(level.polygons).index(k) + 1) for k in chosen) or "none"
        for level, chosen in ((before, linked.before), (after, linked.after))
    ]
    return f"loop {numbers[0]} → {numbers[1]}"


def tangle(before: Level, after: Level, linked: LinkedLoops) -> InputError:
    """Return the error for loops that no steps lead through."""
    return InputError(
        "neighbouring sections cannot be linked: loops part and meet between them in more ways than one",
        where=f"{before.name} to {after.name}",
        found=f"{len(linked.before)} loops, then {len(linked.after)}",
        fix="cut thinner slices there, say links in stack.toml, or use --method shape-interpolation or"
        " cavalieri",
    )
