"""Two lobes and a waist: sections that turn from convex to peanut-shaped and back; and a dumbbell."""

from __future__ import annotations

import math

import numpy as np

from stackloft.testing.phantoms.body import Body, Patch
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.pose import euler
from stackloft.testing.phantoms.quadrature import figures
from stackloft.testing.phantoms.star_body import direction


def two_lobed(
    a: float = 45.0,
    b: float = 26.0,
    c: float = 30.0,
    pinch: float = 0.42,
    neck: float = 0.22,
    fade: float = 0.6,
) -> Body:
    """Return x²/a² + (y/(b·w))² + z²/c² ≤ 1 with w(x, z) = 1 − pinch·exp(−(x/(neck·a))² − (z/(fade·c))⁴).

    The lobes lie at ±x, in the picture. Seen along z the sections at mid-height are peanuts, concave at a
    waist of 65 % of the lobes; towards both ends the pinch fades and they are convex. Every section is
    one loop, star-shaped about x = y = 0. V and S by quadrature.

    Parameters
    ----------
    a, b, c : float
        Semi-axes without the pinch, mm.
    pinch : float
        0 to 0.7; how much of the width is missing in the middle.
    neck : float
        0.1 to 1; half-length of the waist over a.
    fade : float
        0.3 to 2; height over c at which the waist has nearly gone.

    Examples
    --------
    >>> round(two_lobed(3, 2, 1, pinch=0).volume / np.pi, 12)
    8.0
    """
    positive(a=a, b=b, c=c)
    within(0, 0.7, pinch=pinch)
    within(0.1, 1, neck=neck)
    within(0.3, 2, fade=fade)

    def width(x: Array, z: Array) -> Array:
        w: Array = b * (1 - pinch * np.exp(-((x / (neck * a)) ** 2) - (z / (fade * c)) ** 4))
        return w

    def surface(longitude: Array, latitude: Array) -> Array:
        d = direction(longitude, latitude)
        return np.stack([a * d[0], width(a * d[0], c * d[2]) * d[1], c * d[2]])

    patches = (Patch(surface, (-np.pi, np.pi), (-np.pi / 2, np.pi / 2), ("periodic", "gauss")),)
    volume, area = figures(patches)
    return Body(
        fields=(lambda X: (X[0] / a) ** 2 + (X[1] / width(X[0], X[2])) ** 2 + (X[2] / c) ** 2 - 1,),
        patches=patches,
        volume=volume,
        area=area,
        parameters={"a": a, "b": b, "c": c, "pinch": pinch, "neck": neck, "fade": fade},
    )


def dumbbell(
    length: float = 100.0, thickness: float = 44.0, pinch: float = 0.4, neck: float = 0.3, tilt: float = 50.0
) -> Body:
    """Return a round two-lobed body whose axis leans by `tilt` degrees from z towards x.

    About its own axis its radius is (thickness/2)·w(s)·√(1 − s²), s from −1 to 1 along it, with
    w = 1 − pinch·exp(−(s/neck)²). Cut obliquely, sections near the ends are convex and those in the
    middle take in both lobes and the waist. V = π·(thickness/2)²·(length/2)·∫ w²·(1 − s²) ds.

    Parameters
    ----------
    length, thickness : float
        mm
    pinch : float
        0 to 0.7.
    neck : float
        0.1 to 1; half-length of the waist over half the length.
    tilt : float
        Degrees, −60 to 60; leaning further, the lobes' sections come apart.

    Examples
    --------
    >>> round(dumbbell(2, 2, pinch=0).volume / np.pi, 12) == round(4 / 3, 12)
    True
    """
    positive(length=length, thickness=thickness)
    within(0, 0.7, pinch=pinch)
    within(0.1, 1, neck=neck)
    within(-60, 60, tilt=tilt)
    half, lean = thickness / 2, euler(0, tilt, 0)

    def width(s: Array) -> Array:
        w: Array = 1 - pinch * np.exp(-((s / neck) ** 2))
        return w

    def surface(longitude: Array, latitude: Array) -> Array:
        d = direction(longitude, latitude)
        w = half * width(d[2])
        return np.tensordot(lean, np.stack([w * d[0], w * d[1], length / 2 * d[2]]), axes=1)

    def inside(X: Array) -> Array:
        x, y, z = lean.T @ X
        s = 2 * z / length
        value: Array = (x**2 + y**2) / (half * width(s)) ** 2 + s**2 - 1
        return value

    patches = (Patch(surface, (-np.pi, np.pi), (-np.pi / 2, np.pi / 2), ("periodic", "gauss")),)
    lost = 2 * pinch * _gauss_moment(neck) - pinch**2 * _gauss_moment(neck / math.sqrt(2))
    return Body(
        (inside,),
        patches,
        volume=np.pi * half**2 * length / 2 * (4 / 3 - lost),
        area=figures(patches)[1],
        parameters={"length": length, "thickness": thickness, "pinch": pinch, "neck": neck, "tilt": tilt},
    )


def _gauss_moment(s: float) -> float:
    """Return ∫ (1 − t²)·exp(−t²/s²) dt over −1…1, by parts."""
    zeroth = s * math.sqrt(math.pi) * math.erf(1 / s)
    return zeroth * (1 - s * s / 2) + s * s * math.exp(-1 / (s * s))
