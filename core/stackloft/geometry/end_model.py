"""Where a body ends beyond its outermost section, learned from the section areas.

Near a pole the area goes as A ∝ (z₀ − z)^q: q = 1 for a smooth round end, 2 for a sharp tip, below 1
for blunt ones. A^(1/q) is then smooth, so the parabola through its last three values has its root at z₀;
for q = 1 and an ellipsoid that root is exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

TIP = 2.0
"""q of a sharp tip."""
ROUND = 1.0
"""q of a smooth round end."""
SHAPES = (2.0 / 3.0, 4.0 / 3.0)
"""Exponents between which a body's end is expected: blunter and sharper than round."""
PARABOLA = 3
BLUNT = 0.5
"""Length of the bluntest cap of a limb, in lengths of a round one."""
TOUCHING = 1e-9
"""Of b², a discriminant that is zero but for rounding: a cone's areas only touch zero at its apex."""
FARTHEST = 1e6
"""Times the depth of the sections looked at beyond which nothing closes."""


def distance_to_end(areas: FloatArray, depth: FloatArray, q: float = ROUND) -> float | None:
    """Return how far beyond the outermost section the area reaches zero.

    Parameters
    ----------
    areas : (k,) array
        Section areas from the outermost inwards, mm², k ≥ 1; the first three are used.
    depth : (k,) array
        Distance of each section inwards from the outermost, mm; depth[0] = 0.
    q : float
        Exponent of A ∝ (z₀ − z)^q.

    Returns
    -------
    float or None
        mm, positive; None when the areas do not go to zero (or there are fewer than 2).

    Examples
    --------
    >>> z = np.array([9.0, 7.0, 5.0])
    >>> round(distance_to_end(10.0**2 - z**2, 9.0 - z), 12)  # a ball of radius 10
    1.0
    """
    value = areas[:3] ** (1.0 / q)
    x = depth[: len(value)]
    if len(value) < 2:
        return None
    # value ≈ a + b·depth + c·depth²; the end lies at depth = -distance
    c, b, a = np.polyfit(x, value, 2) if len(value) == 3 else (0.0, *np.polyfit(x, value, 1))
    roots = _positive_roots(c, -b, a)
    # areas that are equal but for rounding do not close, whichever way the rounding goes
    return float(min(roots)) if roots and min(roots) < FARTHEST * x[-1] else None


def _positive_roots(c: float, b: float, a: float) -> list[float]:
    """Return the positive roots of c·t² + b·t + a."""
    if abs(c) * a <= 1e-14 * b * b:
        return [-a / b] if b < 0 else []
    discriminant = b * b - 4.0 * a * c
    if abs(discriminant) < TOUCHING * b * b:
        discriminant = 0.0
    if discriminant < 0.0:
        return []
    half = -0.5 * (b + math.copysign(math.sqrt(discriminant), b))
    return [t for t in (half / c, a / half if half else 0.0) if t > 0.0]


@dataclass(frozen=True, slots=True)
class EndGuess:
    """What the areas say about one end."""

    length: float
    """mm beyond the outermost section."""
    pointed: bool
    """True for a sharp tip."""
    reason: str
    shortest: float
    """mm, by the bluntest shape of `SHAPES`."""
    longest: float
    """mm, by the sharpest."""


def guess_end(
    areas: FloatArray, depth: FloatArray, pitch: float, seen: float = 0.0, limb: float | None = None
) -> EndGuess:
    """Return the most plausible end when nobody said where the body ends.

    Parameters
    ----------
    areas, depth : (k,) arrays
        As for `distance_to_end`.
    pitch : float
        Distance between cuts, mm: the end is never further, or it would show on one more section.
    seen : float
        How far beyond the outermost section the body still showed, mm: the end is beyond that.
    limb : float, optional
        Where an even limb ends (`distance_to_limb_end`), mm; None for what is no limb.

    Returns
    -------
    EndGuess
        A sharp tip when √A runs straight to zero; otherwise the root of the area's parabola, held to
        one pitch; half a pitch when the areas do not close.
    """
    roots = [distance_to_end(areas, depth, q) for q in (*SHAPES, ROUND)]
    furthest = seen + pitch
    lengths = [float(np.clip(root or seen + 0.5 * pitch, seen, furthest)) for root in roots]
    low, high = min(lengths), max(lengths)
    tip = distance_to_end(areas, depth, TIP)
    beyond = furthest * (1.0 + TOUCHING)  # what ends just one pitch away does so however it is rounded
    if tip is not None and seen <= tip <= beyond and _is_tip(areas, depth):
        reason = "the square root of the area runs straight to zero"
        return EndGuess(tip, True, reason, min(low, tip), tip)
    if limb is not None and seen <= limb <= furthest:
        return EndGuess(
            limb, False, "an even limb with a round cap", max(seen, BLUNT * limb), max(high, limb)
        )
    root = roots[-1]
    if root is None:
        reason = "the areas do not close, half a pitch was assumed"
    elif root > beyond:
        reason = "the areas close later than one pitch, one pitch was assumed"
        low = min(low, seen + 0.5 * pitch)
    elif len(areas) < PARABOLA:
        reason = "the last two sections, carried on, reach zero there"
    else:
        reason = "the parabola through the last three areas reaches zero there"
    return EndGuess(lengths[-1], False, reason, low, high)


def _is_tip(areas: FloatArray, depth: FloatArray) -> bool:
    """Return whether √A of the outermost three sections is a straight line within 2 % of its rise.

    A round end's √A bends: on an ellipsoid the middle one stands 11 % or more of the rise above the line.
    """
    if len(areas) < 3:
        return False
    root = np.sqrt(areas[:3])
    rise = root[2] - root[0]
    if rise <= 0.0:
        return False
    straight = root[0] + rise * depth[1] / depth[2]
    return bool(abs(root[1] - straight) < 0.02 * rise)


def local_exponent(areas: FloatArray, depth: FloatArray, length: float) -> float:
    """Return q of A ∝ (z₀ − z)^q between the outermost two sections, the end being known.

    Examples
    --------
    >>> z = np.array([9.0, 7.0])
    >>> round(local_exponent((10.0 - z) ** 2, 9.0 - z, 1.0), 9)  # a cone
    2.0
    """
    if len(areas) < 2:
        return ROUND
    ratio = math.log((length + depth[1]) / length)
    return math.log(areas[1] / areas[0]) / ratio
