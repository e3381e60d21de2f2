"""What a person should know about slabs that leave gaps, overlap, or have no known thickness."""

from __future__ import annotations

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.notices import Notice

_EVEN = 0.02
"""Thickness and pitch that differ by less than this fraction of the pitch are the same."""


def slab_notices(positions: FloatArray, thickness: FloatArray | None) -> tuple[Notice, ...]:
    """Return a notice when slices leave gaps, overlap, or do not say how thick they are.

    Parameters
    ----------
    positions : ndarray, (m)
        mm, increasing.
    thickness : ndarray, (m), or None
        mm

    Examples
    --------
    >>> slab_notices(np.array([0.0, 10, 20]), np.full(3, 5.0))[0].message
    'slices are 5 mm thick at a pitch of 10 mm: 50 % of the body lies between them and is interpolated'
    """
    if thickness is None:
        return (Notice("thickness-unknown", "the slices' own thickness is not given; positions are"),)
    pitch = float(np.median(np.diff(positions)))
    thick = float(np.median(thickness))
    told = f"slices are {thick:g} mm thick at a pitch of {pitch:.4g} mm"
    if thick < (1 - _EVEN) * pitch:
        share = 100 * (1 - thick / pitch)
        text = f"{told}: {share:.0f} % of the body lies between them and is interpolated"
        return (Notice("slab-gaps", text),)
    if thick > (1 + _EVEN) * pitch:
        return (
            Notice("slab-overlap", f"{told}: they overlap, so each blurs the body's ends along the axis"),
        )
    return ()
