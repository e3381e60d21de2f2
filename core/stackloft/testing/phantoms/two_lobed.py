"""Two lobes and a waist: sections that turn from convex to peanut-shaped and back; and a dumbbell."""

from __future__ import annotations

import math

import numpy as np

from stackloft.testing.phantoms.body import Body, Patch
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.quadrature import figures
from stackloft.testing.phantoms.star_body import direction


def two_lobed(
    a: float = 45.0, b: float = 26.0, c: float = 30.0, pinch: float = 0.45, neck: float = 0.3
) -> Body:
    """Return x²/a² + (y/(b·w(x)))² + z²/c² ≤ 1 with w(x) = 1 − pinch·exp(−(x/(neck·a))²).

    The lobes lie at ±x, in the picture: seen along z the section at mid-height is a peanut, concave at
    the waist; towards both ends it lies within the neck and is convex. Every section is one loop,
    star-shaped about x = y = 0. V = π·bc·∫ w·(1 − x²/a²) dx in closed form; S by quadrature.

    Parameters
    ----------
    a, b, c : float
        Semi-axes without the pinch, mm.
    pinch : float
        0 to 0.7; how much of the width is missing at x = 0.
    neck : float
        0.1 to 1; half-length of the waist over a.

    Examples
    --------
    >>> two_lobed(3, 2, 1, pinch=0).volume / np.pi
    8.0
    """
    positive(a=a, b=b, c=c)
    within(0, 0.7, pinch=pinch)
    within(0.1, 1, neck=neck)

    def width(x: Array) -> Array:
        w: Array = b * (1 - pinch * np.exp(-((x / (neck * a)) ** 2)))
        return w

    def surface(longitude: Array, latitude: Array) -> Array:
        d = direction(longitude, latitude)
        return np.stack([a * d[0], width(a * d[0]) * d[1], c * d[2]])

    patches = (Patch(surface, (-np.pi, np.pi), (-np.pi / 2, np.pi / 2), ("periodic", "gauss")),)
    return Body(
        fields=(lambda X: (X[0] / a) ** 2 + (X[1] / width(X[0])) ** 2 + (X[2] / c) ** 2 - 1,),
        patches=patches,
        volume=np.pi * a * b * c * (4 / 3 - pinch * _gauss_moment(neck)),
        area=figures(patches)[1],
        parameters={"a": a, "b": b, "c": c, "pinch": pinch, "neck": neck},
    )


def _gauss_moment(s: float) -> float:
    """Return ∫ (1 − t²)·exp(−t²/s²) dt over −1…1, by parts."""
    zeroth = s * math.sqrt(math.pi) * math.erf(1 / s)
    return zeroth * (1 - s * s / 2) + s * s * math.exp(-1 / (s * s))
