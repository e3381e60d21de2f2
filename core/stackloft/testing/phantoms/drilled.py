r"""Cylinders with a hole beside their axis: right through, or from one end.

::

     .-----. ___ .---.          .-----. ___ .---.     fields of the blind hole: side, bottom and top,
     |     |     |   |          |     |     |   |     less the bore above its floor, as the union
     | tube|     |   |          |     |_____|   |     { side, bottom, top, not bore } or
     |     |     |   |          |  blind hole   |     { side, bottom, below the floor }
     `-----'-----'---'          `---------------'
"""

from __future__ import annotations

import math

import numpy as np

from stackloft.testing.phantoms.body import Body, Field, Patch, Plane
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.combining import turned_over
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.round_bars import length_of

_UP = np.array([0.0, 0.0, 1.0])


def tube(radius: float = 30.0, height: float = 80.0, bore: float = 12.0, offset: float = 9.0) -> Body:
    """Return the cylinder about z with a round hole of radius `bore` through it, `offset` off axis, mm.

    V = π·h·(R² − b²), S = 2π·h·(R + b) + 2π·(R² − b²).

    Examples
    --------
    >>> round(tube(3, 5, 1, 1).volume / np.pi, 12), round(tube(3, 5, 1, 1).area / np.pi, 12)
    (40.0, 56.0)
    """
    _checked(radius, height, bore, offset)
    half = height / 2
    return Body(
        fields=(_round(radius, 0.0), _bored(bore, offset), Plane(_UP, half), Plane(-_UP, half)),
        patches=(
            _side(radius, 0.0, (-half, half)),
            turned_over(_side(bore, offset, (-half, half))),
            _face(radius, (bore, offset), half, up=True),
            _face(radius, (bore, offset), -half, up=False),
        ),
        volume=math.pi * height * (radius**2 - bore**2),
        area=2 * math.pi * (height * (radius + bore) + radius**2 - bore**2),
        parameters={"radius": radius, "height": height, "bore": bore, "offset": offset},
        detail=181,
    )


def blind_hole(
    radius: float = 30.0, height: float = 80.0, bore: float = 12.0, offset: float = 8.0, depth: float = 52.0
) -> Body:
    """Return the cylinder about z with a flat-bottomed round hole from its upper end, `depth` deep, mm.

    V = π·(R²·h − b²·d), S = 2π·(R·h + b·d) + 2π·R².

    Examples
    --------
    >>> body = blind_hole(3, 5, 1, 1, 2)
    >>> round(body.volume / np.pi, 12), round(body.area / np.pi, 12)
    (43.0, 52.0)
    """
    _checked(radius, height, bore, offset)
    positive(depth=depth)
    within(0, 0.95 * height, depth=depth)
    half = height / 2
    floor = half - depth
    return Body(
        fields=(
            _round(radius, 0.0),
            Plane(-_UP, half),
            Plane(_UP, half),
            _bored(bore, offset),
            Plane(_UP, floor),
        ),
        patches=(
            _side(radius, 0.0, (-half, half)),
            turned_over(_side(bore, offset, (floor, half))),
            _face(radius, (bore, offset), half, up=True),
            _face(radius, (0.0, 0.0), -half, up=False),
            _disc(bore, offset, floor),
        ),
        volume=math.pi * (radius**2 * height - bore**2 * depth),
        area=2 * math.pi * (radius * height + bore * depth + radius**2),
        parameters={"radius": radius, "height": height, "bore": bore, "offset": offset, "depth": depth},
        parts=((0, 1, 2, 3), (0, 1, 4)),
        detail=181,
    )


def _checked(radius: float, height: float, bore: float, offset: float) -> None:
    positive(radius=radius, height=height, bore=bore)
    within(0, 0.95 * radius - bore, offset=offset)


def _round(radius: float, offset: float) -> Field:
    def value(X: Array) -> Array:
        distance: Array = length_of(np.stack([X[0] - offset, X[1]])) - radius
        return distance

    return value


def _bored(bore: float, offset: float) -> Field:
    inside = _round(bore, offset)

    def value(X: Array) -> Array:
        distance: Array = -inside(X)
        return distance

    return value


def _side(radius: float, offset: float, span: tuple[float, float]) -> Patch:
    def surface(angle: Array, z: Array) -> Array:
        return np.stack([offset + radius * np.cos(angle), radius * np.sin(angle), z + 0 * angle])

    return Patch(surface, (-np.pi, np.pi), span, ("periodic", "gauss"))


def _face(radius: float, opening: tuple[float, float], z: float, *, up: bool) -> Patch:
    """Return the plane end between the rim and an opening (radius, offset), straight lines joining them."""
    bore, offset = opening

    def surface(angle: Array, t: Array) -> Array:
        r = bore * (1 - t) + radius * t
        return np.stack([offset * (1 - t) + r * np.cos(angle), r * np.sin(angle), z + 0 * r])

    patch = Patch(surface, (-np.pi, np.pi), (0.0, 1.0), ("periodic", "gauss"))
    return turned_over(patch) if up else patch


def _disc(radius: float, offset: float, z: float) -> Patch:
    def surface(r: Array, angle: Array) -> Array:
        return np.stack([offset + r * np.cos(angle), r * np.sin(angle), z + 0 * r])

    return Patch(surface, (0.0, radius), (-np.pi, np.pi), ("gauss", "periodic"))
