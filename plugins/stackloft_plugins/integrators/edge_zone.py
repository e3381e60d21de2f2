"""The zone of partly filled pixels about a slice's edge: how many, and how much of grey they hold."""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.coverage import Covered, Rings, covered
from stackloft.geometry.disc_reach import disc_reach
from stackloft_plugins.integrators.morphology import Mask, dilated, disc, eroded
from stackloft_plugins.integrators.ring_levels import level_of, ring_values
from stackloft_plugins.integrators.seen_slice import SeenSlice

Beside = tuple[SeenSlice | None, SeenSlice | None]
"""The slices before and after."""
_FEW = 4
"""Innermost pixels of a thin body for their level to count."""


def edge_zone(current: SeenSlice, beside: Beside, zone: int, rings: Rings | None = None) -> Covered:
    """Return the counts and sums over a slice's edge zone, given its neighbours.

    Parameters
    ----------
    current : SeenSlice
    beside : tuple
        The slices before and after (the slice itself, where they do not matter); None where there is none.
    zone : int
        Pixels that it reaches to either side of the edge.
    rings : Rings, optional
        What is wanted of the rings beside the zone.
    """
    quick = _compiled(current, beside, zone, rings)
    return _by_opencv(current, beside, zone, rings) if quick is None else quick


def innermost(current: SeenSlice, beside: Beside) -> float:
    """Return the level of a thin body's innermost pixels; NaN of too few."""
    deep = eroded(_common_united(current, beside)[0], disc(1)).view(np.bool_)
    return level_of(current.section.relative_where(deep), _FEW)


def _compiled(current: SeenSlice, beside: Beside, zone: int, rings: Rings | None) -> Covered | None:
    own, (first, last) = current.shown, (None if seen is None else seen.shown for seen in beside)
    unknown = any(
        seen is not None and shown is None for seen, shown in zip(beside, (first, last), strict=True)
    )
    if own is None or unknown:
        return None
    return covered(own, current.section.noise, (first, last), _reach(zone), rings)


def _by_opencv(current: SeenSlice, beside: Beside, zone: int, rings: Rings | None) -> Covered:
    common, united = _common_united(current, beside)
    inside, near = eroded(common, disc(zone)), dilated(united, disc(zone))
    between = np.flatnonzero((inside ^ near).view(np.bool_))
    edge = current.section.relative_at(between)
    full = edge[common.ravel().take(between).view(np.bool_)]
    values = None if rings is None else ring_values(current.section, inside, near, rings)
    return Covered(
        cv2.countNonZero(inside), len(edge), float(edge.sum()), len(full), float(full.sum()), values
    )


def _common_united(current: SeenSlice, beside: Beside) -> tuple[Mask, Mask]:
    """Return where the body is on all three slices, and where it is on any."""
    own = current.mask(current.window)
    others = [np.zeros_like(own) if seen is None else seen.mask(current.window) for seen in beside]
    return own & others[0] & others[1], own | others[0] | others[1]


@lru_cache
def _reach(zone: int) -> NDArray[np.int32]:
    return disc_reach(disc(zone))
