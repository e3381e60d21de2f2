"""Closed shells: a ball with a cavity beside its centre, with two cavities; a walnut."""

from __future__ import annotations

import math

import numpy as np

from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.body import Body
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.combining import hollowed, moved
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.ellipsoids import ellipsoid
from stackloft.testing.phantoms.star_body import star_body


def hollow_sphere(radius: float = 35.0, cavity: float = 19.0, offset: float = 9.0) -> Body:
    """Return a ball with a round cavity whose centre lies `offset` mm from its own, along (2, 1, −1).

    V = 4/3·π·(R³ − c³), S = 4π·(R² + c²).

    Examples
    --------
    >>> round(hollow_sphere(3, 1, 1).volume / np.pi * 3 / 4, 9)
    26.0
    """
    positive(radius=radius, cavity=cavity)
    within(0, 0.95 * radius - cavity, offset=offset)
    centre = offset * np.array([2.0, 1.0, -1.0]) / math.sqrt(6)
    given = {"radius": radius, "cavity": cavity, "offset": offset}
    return hollowed(_ball(radius), moved(_ball(cavity), centre), parameters=given)


def two_cavities(radius: float = 36.0, first: float = 14.0, second: float = 10.0) -> Body:
    """Return a ball with two round cavities of radii `first` and `second`, mm, the second higher up.

    The first lies at radius·(−0.35, 0.1, −0.25), the second at radius·(0.35, −0.15, 0.35).

    Examples
    --------
    >>> round(two_cavities(9, 3, 2).volume / np.pi * 3 / 4, 9)
    694.0
    """
    positive(radius=radius, first=first, second=second)
    places = radius * np.array([[-0.35, 0.1, -0.25], [0.35, -0.15, 0.35]])
    near = np.linalg.norm(places, axis=1)
    if (
        first + near[0] > 0.97 * radius
        or second + near[1] > 0.97 * radius
        or (first + second > 0.97 * float(np.linalg.norm(places[0] - places[1])))
    ):
        raise UsageError("the cavities touch", where="two-cavities", found=f"{first:g} and {second:g} mm",
                         expected=f"about {0.38 * radius:g} and {0.28 * radius:g} mm")  # fmt: skip
    holes = [moved(_ball(r), place) for r, place in zip((first, second), places, strict=True)]
    given = {"radius": radius, "first": first, "second": second}
    return hollowed(_ball(radius), *holes, parameters=given)


def walnut(
    diameter: float = 68.0, wrinkles: float = 0.025, frequency: float = 6.0, ridge: float = 0.35
) -> Body:
    """Return a walnut-like shell: wrinkled outside, hollow, the cavity parted by a ridge.

    Outside, with d the direction and k the frequency, the distance from the centre is
    R·(1 + wrinkles·g(k·d)), g the gyroid's sin x·cos y + sin y·cos z + sin z·cos x; inside it is
    0.64·R·(1 − ridge·e^(−(n·d/0.3)²)) with n across the ridge. The body is 1.12 times as long along z. V and
    S by quadrature.

    Parameters
    ----------
    diameter : float
        mm
    wrinkles : float
        0 to 0.05.
    frequency : float
        1 to 12.
    ridge : float
        0 to 0.5.

    Examples
    --------
    >>> shell = walnut(wrinkles=0, ridge=0, diameter=2)
    >>> round(shell.volume / np.pi * 3 / 4, 9) == round(1.12 * (1 - 0.64**3), 9)
    True
    """
    positive(diameter=diameter, frequency=frequency)
    within(0, 0.05, wrinkles=wrinkles)
    within(1, 12, frequency=frequency)
    within(0, 0.5, ridge=ridge)
    stretch = np.array([1.0, 1.0, 1.12])
    across = np.array([0.8, 0.6, 0.0])

    def outer(d: Array) -> Array:
        x, y, z = frequency * d
        gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        r: Array = diameter / 2 * (1 + wrinkles * gyroid)
        return r

    def inner(d: Array) -> Array:
        r: Array = 0.32 * diameter * (1 - ridge * np.exp(-((across @ d / 0.3) ** 2)))
        return r

    given = {"diameter": diameter, "wrinkles": wrinkles, "frequency": frequency, "ridge": ridge}
    return hollowed(star_body(outer, stretch, {}), star_body(inner, stretch, {}), parameters=given)


def _ball(radius: float) -> Body:
    return ellipsoid(radius, radius, radius)
