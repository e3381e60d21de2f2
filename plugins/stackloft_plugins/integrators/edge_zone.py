"""The zone of partly filled pixels about a slice's edge: how many, and how much of grey they hold."""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.coverage import Covered, covered
from stackloft.geometry.disc_reach import disc_reach
from stackloft_plugins.integrators.ring_levels import dilated, disc, eroded
from stackloft_plugins.integrators.seen_slice import SeenSlice

Beside = tuple[SeenSlice | None, SeenSlice | None]
"""The slices before and after."""


def edge_zone(current: SeenSlice, beside: Beside, zone: int, *, masks: bool) -> Covered:
    """Return the counts and sums over a slice's edge zone, given its neighbours.

    Parameters
    ----------
    current : SeenSlice
    beside : tuple
        The slices before and after (the slice itself, where they do not matter); None where there is none.
    zone : int
        Pixels that it reaches to either side of the edge.
    masks : bool
        Whether the masks are wanted.
    """
    quick = _compiled(current, beside, zone, masks=masks)
    return _by_opencv(current, beside, zone) if quick is None else quick


def _compiled(current: SeenSlice, beside: Beside, zone: int, *, masks: bool) -> Covered | None:
    own, others = current.shown, [None if seen is None else seen.shown for seen in beside]
    if own is None or any(
        seen is not None and shown is None for seen, shown in zip(beside, others, strict=True)
    ):
        return None
    first, last = others
    return covered(own, current.section.noise, (first, last), _reach(zone), masks=masks)


def _by_opencv(current: SeenSlice, beside: Beside, zone: int) -> Covered:
    own = current.mask(current.window)
    others = [np.zeros_like(own) if seen is None else seen.mask(current.window) for seen in beside]
    common, united = own & others[0] & others[1], own | others[0] | others[1]
    inside, near = eroded(common, disc(zone)), dilated(united, disc(zone))
    between = np.flatnonzero((inside ^ near).view(np.bool_))
    edge = current.section.relative_at(between)
    full = edge[common.ravel().take(between).view(np.bool_)]
    masks = np.stack([inside, near, common])
    return Covered(
        cv2.countNonZero(inside), len(edge), float(edge.sum()), len(full), float(full.sum()), masks
    )


@lru_cache
def _reach(zone: int) -> NDArray[np.int32]:
    return disc_reach(disc(zone))
