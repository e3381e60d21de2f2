"""A square bar twisted about its axis."""

from __future__ import annotations

import math

import numpy as np

from stackloft.testing.phantoms.body import Body, Field, Patch, Plane
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array


def twisted_bar(side: float = 40.0, height: float = 90.0, twist: float = 60.0) -> Body:
    """Return the square bar whose section turns by `twist` degrees over its height, axis along z.

    V = side²·height. A side is swept by a straight edge: with k = twist/height (radians) its area
    element is √(1 + k²t²), so S = 2·side² + 4·height·∫ √(1 + k²t²) dt over −side/2…side/2.

    Examples
    --------
    >>> twisted_bar(2, 5, 0).area
    48.0
    """
    positive(side=side, height=height)
    within(-720, 720, twist=twist)
    k, half = math.radians(twist) / height, side / 2
    stroke = half * math.sqrt(1 + (k * half) ** 2) + (math.asinh(k * half) / k if k else half)
    quarters = [i * math.pi / 2 for i in range(4)]
    ends = tuple(Plane(np.array([0.0, 0.0, sign]), height / 2) for sign in (1.0, -1.0))
    return Body(
        fields=tuple(_side_field(k, half, angle) for angle in quarters) + ends,
        patches=tuple(_side_patch(k, half, height, angle) for angle in quarters)
        + tuple(_end_patch(k, half, sign * height / 2) for sign in (1.0, -1.0)),
        volume=side**2 * height,
        area=2 * side**2 + 4 * height * stroke,
        tips=np.array(
            [
                _turned(k, angle + math.pi / 4, half * math.sqrt(2), z)
                for angle in quarters
                for z in (-height / 2, height / 2)
            ]
        ),
        parameters={"side": side, "height": height, "twist": twist},
    )


def _turned(k: float, angle: float, radius: float, z: float) -> list[float]:
    return [radius * math.cos(angle + k * z), radius * math.sin(angle + k * z), z]


def _side_field(k: float, half: float, angle: float) -> Field:
    def value(X: Array) -> Array:
        turn = angle + k * X[2]
        distance: Array = X[0] * np.cos(turn) + X[1] * np.sin(turn) - half
        return distance

    return value


def _side_patch(k: float, half: float, height: float, angle: float) -> Patch:
    def surface(t: Array, z: Array) -> Array:
        turn = angle + k * z
        c, s = np.cos(turn), np.sin(turn)
        return np.stack([half * c - t * s, half * s + t * c, z + 0 * t])

    return Patch(surface, (-half, half), (-height / 2, height / 2))


def _end_patch(k: float, half: float, z: float) -> Patch:
    c, s, up = math.cos(k * z), math.sin(k * z), math.copysign(1.0, z)

    def surface(u: Array, v: Array) -> Array:
        return np.stack([u * c - up * v * s, u * s + up * v * c, z + 0 * u])

    return Patch(surface, (-half, half), (-half, half))
