"""A coil: a round bar about a helix, its turns apart, its ends round."""

from __future__ import annotations

import math

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.body import Body, Patch
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.round_bars import cap_patch, frame_of, length_of

_NEWTON = 12
_SETTLED = 1e-12


def coil(ring: float = 24.0, radius: float = 6.5, pitch: float = 21.0, turns: float = 2.25) -> Body:
    """Return a round bar of `radius` about the helix (ring·cos t, ring·sin t, pitch·t/2π), mm.

    V = π·r²·L + 4/3·π·r³ and S = 2π·r·L + 4π·r², L = 2π·turns·√(ring² + (pitch/2π)²) the helix' length: a
    canal surface bends without change of either while its radius stays below the radius of curvature.

    Parameters
    ----------
    ring, radius, pitch : float
        mm; the turns must not touch.
    turns : float
        0.25 to 10.

    Examples
    --------
    >>> L = 2 * np.pi * 2 * np.hypot(5.0, 4 / (2 * np.pi))
    >>> round(coil(5, 1, 4, 2).volume / np.pi - 4 / 3, 9) == round(float(L), 9)
    True
    """
    positive(ring=ring, radius=radius, pitch=pitch)
    within(0.25, 10, turns=turns)
    within(0, 0.9 * ring, radius=radius)
    rise, last = pitch / (2 * math.pi), math.pi * turns
    within(0, 0.48 * pitch * ring / math.hypot(ring, rise), radius=radius)
    speed = math.hypot(ring, rise)
    length = 2 * last * speed

    def axis(t: Array) -> Array:
        return np.stack([ring * np.cos(t), ring * np.sin(t), rise * t])

    def value(X: Array) -> Array:
        # at the nearest point the distance does not change with t: t may stay real
        distance: Array = length_of(X - axis(_nearest(X.real, ring, rise, last))) - radius
        return distance

    def surface(around: Array, t: Array) -> Array:
        inward = np.stack([-np.cos(t), -np.sin(t), 0 * t])
        up = np.stack([rise * np.sin(t), -rise * np.cos(t), ring + 0 * t]) / speed
        point: Array = axis(t) + radius * (np.cos(around) * inward + np.sin(around) * up)
        return point

    caps = []
    for t, sign in ((-last, -1.0), (last, 1.0)):
        along = sign * np.array([-ring * math.sin(t), ring * math.cos(t), rise]) / speed
        outward = np.array([math.cos(t), math.sin(t), 0.0])
        caps.append(cap_patch(axis(np.array([t]))[:, 0], frame_of(along, outward), radius))
    return Body(
        fields=(value,),
        patches=(Patch(surface, (-np.pi, np.pi), (-last, last), ("periodic", "gauss")), *caps),
        volume=math.pi * radius**2 * (length + 4 / 3 * radius),
        area=2 * math.pi * radius * (length + 2 * radius),
        parameters={"ring": ring, "radius": radius, "pitch": pitch, "turns": turns},
        detail=241,
    )


def _nearest(X: FloatArray, ring: float, rise: float, last: float) -> FloatArray:
    """Return the helix parameter of the nearest axis point, (n): Newton's method above and below."""
    x, y, z = X
    angle = np.arctan2(y, x)
    turn = np.floor((z / rise - angle) / (2 * math.pi))
    first, second = (_settled(angle + 2 * math.pi * (turn + k), X, ring, rise, last) for k in (0, 1))
    return np.where(_squared(first, X, ring, rise) < _squared(second, X, ring, rise), first, second)


def _settled(start: FloatArray, X: FloatArray, ring: float, rise: float, last: float) -> FloatArray:
    x, y, z = X
    t = np.clip(start, -last, last)
    for _ in range(_NEWTON):
        c, s = np.cos(t), np.sin(t)
        slope = ring * (x * s - y * c) + rise * (rise * t - z)
        bend = np.maximum(ring * (x * c + y * s), 0.05 * ring**2) + rise**2
        before, t = t, np.clip(t - np.clip(slope / bend, -0.5, 0.5), -last, last)
        if np.abs(t - before).max() < _SETTLED:
            break
    return t


def _squared(t: FloatArray, X: FloatArray, ring: float, rise: float) -> FloatArray:
    x, y, z = X
    found: FloatArray = (x - ring * np.cos(t)) ** 2 + (y - ring * np.sin(t)) ** 2 + (z - rise * t) ** 2
    return found
