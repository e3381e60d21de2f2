r"""Where an even limb ends: a finger, a sausage, the stem of a fork.

::

      .--.    depth d      sections below the cap are all alike, so areas say nothing of where it closes but
     /    \   ------ A₁    for the one in the cap: a round cap is as high as the limb is half thick, h, and
    |      |  ------ A     A₁/A = 1 − ((h − d)/h)²
    |      |  ------ A

The parabola through the outermost three areas closes far too late there: what is alike below the cap
bends it.
"""

from __future__ import annotations

import numpy as np

from stackloft.geometry.end_model import FloatArray

EVEN = 0.01
"""Areas of sections of an even limb differ by at most this fraction."""
DEEPEST = 2
"""How many outermost sections may lie in the cap."""


def distance_to_limb_end(areas: FloatArray, half_widths: FloatArray, depth: FloatArray) -> float | None:
    """Return how far beyond the outermost section an even limb reaches.

    Parameters
    ----------
    areas : (k,) array
        Section areas from the outermost inwards, mm².
    half_widths : (k,) array
        Half the smaller width of each section, mm.
    depth : (k,) array
        Distance of each section inwards from the outermost, mm; depth[0] = 0.

    Returns
    -------
    float or None
        mm, not negative; None where this is no even limb. It is when, below one or two sections in the cap,
        two are alike and the next one is no smaller: an egg's sections would grow less and then shrink.

    Examples
    --------
    >>> d = np.array([2.0, 10.0, 18.0, 26.0])  # a bar of radius 6 with round ends
    >>> r = np.sqrt(36.0 - np.maximum(6.0 - d, 0.0) ** 2)
    >>> round(distance_to_limb_end(np.pi * r**2, r, d - d[0]), 12)
    2.0
    """
    for k in range(1, DEEPEST + 1):
        if len(areas) < k + 3:
            return None
        below, alike, next_one = areas[k : k + 3]
        if abs(alike - below) > EVEN * below:
            continue
        if next_one < (1.0 - EVEN) * alike or areas[:k].max() >= (1.0 - EVEN) * below:
            return None
        part = float(np.sqrt(1.0 - areas[0] / alike))  # (h - d)/h
        # the section at `k` is below the cap
        height = min(float(half_widths[k + 1]), float(depth[k]) / part)
        return height * (1.0 - part)
    return None
