"""Cylinder, cone and cone frustum."""

from __future__ import annotations

import math

import numpy as np

from stackloft.testing.phantoms.body import Body, Patch, Plane
from stackloft.testing.phantoms.checks import positive
from stackloft.testing.phantoms.dual import Array

_AWAY_FROM_ZERO = 1e-60


def frustum(bottom: float = 34.0, top: float = 18.0, height: float = 70.0) -> Body:
    """Return the cone frustum with end radii `bottom` (at −height/2) and `top` (at +height/2), mm.

    V = π·h/3·(R² + R·r + r²), S = π·(R² + r² + (R + r)·√(h² + (R − r)²)).

    Examples
    --------
    >>> round(frustum(3, 3, 2).volume / np.pi, 12)
    18.0
    """
    positive(bottom=bottom, top=top, height=height)
    return _turned(bottom, top, height, {"bottom": bottom, "top": top, "height": height})


def cylinder(radius: float = 25.0, height: float = 80.0) -> Body:
    """Return the circular cylinder, axis along z, centred on the origin; V = π·r²·h, S = 2π·r·(r + h).

    Examples
    --------
    >>> round(cylinder(3, 2).area / np.pi, 12)
    30.0
    """
    positive(radius=radius, height=height)
    return _turned(radius, radius, height, {"radius": radius, "height": height})


def cone(radius: float = 30.0, height: float = 80.0) -> Body:
    """Return the circular cone, base at −height/2, apex at +height/2; V = π·r²·h/3, S = π·r·(r + √(r² + h²)).

    Examples
    --------
    >>> round(cone(3, 4).area / np.pi, 12)
    24.0
    """
    positive(radius=radius, height=height)
    return _turned(radius, 0.0, height, {"radius": radius, "height": height})


def _turned(bottom: float, top: float, height: float, parameters: dict[str, float]) -> Body:
    """Return the solid under a straight meridian from (bottom, −h/2) to (top, h/2)."""
    middle, slope = (bottom + top) / 2, (top - bottom) / height

    def side(X: Array) -> Array:
        value: Array = np.sqrt(X[0] ** 2 + X[1] ** 2 + _AWAY_FROM_ZERO) - middle - slope * X[2]
        return value

    def surface(angle: Array, z: Array) -> Array:
        r = middle + slope * z
        return np.stack([r * np.cos(angle), r * np.sin(angle), z + 0 * angle])

    half = height / 2
    ends = [(-half, bottom)] + ([(half, top)] if top else [])
    slant = math.hypot(height, bottom - top)
    return Body(
        fields=(side, *(Plane(np.array([0.0, 0.0, math.copysign(1.0, z)]), half) for z, _ in ends)),
        patches=(
            Patch(surface, (-np.pi, np.pi), (-half, half), ("periodic", "gauss")),
            *(_disc(z, r) for z, r in ends),
        ),
        volume=math.pi * height / 3 * (bottom**2 + bottom * top + top**2),
        area=math.pi * (bottom**2 + top**2 + (bottom + top) * slant),
        tips=np.array([[0.0, 0.0, half]]) if not top else np.zeros((0, 3)),
        parameters=parameters,
    )


def _disc(z: float, radius: float) -> Patch:
    up = math.copysign(1.0, z)

    def surface(angle: Array, r: Array) -> Array:
        return np.stack([r * np.cos(angle), -up * r * np.sin(angle), z + 0 * r])

    return Patch(surface, (-np.pi, np.pi), (0, radius), ("periodic", "gauss"))
