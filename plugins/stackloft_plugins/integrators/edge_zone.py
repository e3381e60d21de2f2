"""The zone of partly filled pixels about a slice's edge: how many, and how much of grey they hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.coverage import Covered, Rings, ToCover, covered_all
from stackloft.geometry.disc_reach import disc_reach
from stackloft_plugins.integrators.morphology import Mask, dilated, disc, eroded
from stackloft_plugins.integrators.ring_levels import level_of, ring_values
from stackloft_plugins.integrators.seen_slice import SeenSlice, show_all

Beside = tuple[SeenSlice | None, SeenSlice | None]
"""The slices before and after."""
_FEW = 4
"""Innermost pixels of a thin body for their level to count."""


@dataclass(frozen=True, slots=True, eq=False)
class Neighboured:
    """A slice and those beside it."""

    current: SeenSlice
    beside: Beside
    """The slices before and after (the slice itself, where they do not matter); None where there is none."""
    rings: Rings | None = None
    """What is wanted of the rings beside its edge zone."""


def edge_zones(slices: Sequence[Neighboured], zone: int) -> list[Covered]:
    """Return the counts and sums over slices' edge zones, which reach `zone` pixels to either side."""
    every = {id(seen): seen for one in slices for seen in (one.current, *one.beside) if seen is not None}
    show_all(list(every.values()))
    known = [_to_cover(one) for one in slices]
    quick = iter(covered_all([one for one in known if one is not None], _reach(zone)))
    found = [None if one is None else next(quick) for one in known]
    return [
        _by_opencv(one, zone) if covered is None else covered
        for one, covered in zip(slices, found, strict=True)
    ]


def innermost(one: Neighboured) -> float:
    """Return the level of a thin body's innermost pixels; NaN of too few."""
    deep = eroded(_common_united(one)[0], disc(1)).view(np.bool_)
    return level_of(one.current.section.relative_where(deep), _FEW)


def _to_cover(one: Neighboured) -> ToCover | None:
    """Return a slice for the compiled kernels; None where they cannot do it."""
    seen = (one.current, *one.beside)
    own, first, last = (None if each is None else each.shown for each in seen)
    unknown = any(each is not None and each.shown is None for each in seen)
    return None if own is None or unknown else ToCover(own, (first, last), one.rings)


def _by_opencv(one: Neighboured, zone: int) -> Covered:
    section = one.current.section
    common, united = _common_united(one)
    inside, near = eroded(common, disc(zone)), dilated(united, disc(zone))
    between = np.flatnonzero((inside ^ near).view(np.bool_))
    edge = section.relative_at(between)
    full = edge[common.ravel().take(between).view(np.bool_)]
    values = None if one.rings is None else ring_values(section, inside, near, one.rings)
    return Covered(
        cv2.countNonZero(inside), len(edge), float(edge.sum()), len(full), float(full.sum()), values
    )


def _common_united(one: Neighboured) -> tuple[Mask, Mask]:
    """Return where the body is on all three slices, and where it is on any."""
    window = one.current.window
    own = one.current.mask(window)
    others = [np.zeros_like(own) if seen is None else seen.mask(window) for seen in one.beside]
    return own & others[0] & others[1], own | others[0] | others[1]


@lru_cache
def _reach(zone: int) -> NDArray[np.int32]:
    return disc_reach(disc(zone))
