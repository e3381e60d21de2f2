"""A tapered piece of meat: a plane cut at one end, rounded at the other."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stackloft.testing.phantoms.body import Body, Patch, Plane
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.quadrature import figures

_AWAY_FROM_ZERO = 1e-60
_LUMPS = ((0.07, 0.03), (0.035, -0.05), (0.0, 0.02))
"""Cosine and sine amplitudes of orders 2, 3, 4 of the outline's deviation from an ellipse."""


def meat(
    width: float = 95.0,
    thickness: float = 70.0,
    length: float = 176.0,
    taper: float = 0.35,
    bend: float = 12.0,
) -> Body:
    """Return a piece of meat along z: plane at z = 0, rounded at z = `length`.

    With t = z/length the outline is that of the plane face scaled by (1 − taper·t)·√((1 − t²)(1 + t²/2)),
    its lumps turning a little along z, its centre moving by bend·t² in x.

    Parameters
    ----------
    width, thickness : float
        Of the plane face along x and y before the lumps, mm.
    length : float
        mm
    taper : float
        0 to 0.8.
    bend : float
        How far the rounded end lies beside the axis of the face, mm.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> phantoms.make("meat").end_kinds
    ('face', 'round')
    """
    positive(width=width, thickness=thickness, length=length)
    within(0, 0.8, taper=taper)
    within(-length / 2, length / 2, bend=bend)

    def place(t: Array, x: Array, y: Array) -> Array:
        return np.stack([width / 2 * x + bend * t**2, thickness / 2 * y, length * t])

    def inside(X: Array) -> Array:
        t = X[2] / length
        x, y = (X[0] - bend * t**2) / (width / 2), X[1] / (thickness / 2)
        rho = np.sqrt(x**2 + y**2 + _AWAY_FROM_ZERO)
        squared = (1 - taper * t) ** 2 * (1 - t**2) * (1 + t**2 / 2)
        value: Array = (rho / _outline(x / rho, y / rho, t)) ** 2 - squared
        return value

    patches = _patches(place, taper)
    volume, area = figures(patches)
    given = {"width": width, "thickness": thickness, "length": length, "taper": taper, "bend": bend}
    return Body((inside, Plane(np.array([0.0, 0.0, -1.0]), 0.0)), patches, volume, area, parameters=given)


def _patches(place: Callable[[Array, Array, Array], Array], taper: float) -> tuple[Patch, Patch]:
    """Return the side (t = sin ψ removes the square root at the tip) and the plane face."""

    def side(angle: Array, psi: Array) -> Array:
        t = np.sin(psi)
        scale = (1 - taper * t) * np.cos(psi) * np.sqrt(1 + t**2 / 2)
        reach = scale * _outline(np.cos(angle), np.sin(angle), t)
        return place(t, reach * np.cos(angle), reach * np.sin(angle))

    def face(angle: Array, r: Array) -> Array:
        reach = r * _outline(np.cos(angle), np.sin(angle), 0 * r)
        return place(0 * r, reach * np.cos(angle), reach * np.sin(angle))

    return (
        Patch(side, (-np.pi, np.pi), (0, np.pi / 2), ("periodic", "gauss")),
        Patch(face, (-np.pi, np.pi), (0, 1), ("periodic", "gauss")),
    )


def _outline(c: Array, s: Array, t: Array) -> Array:
    """Return the outline's polar radius for unit vectors (c, s), its lumps turned by 0.6·t radians."""
    turn_c, turn_s = np.cos(0.6 * t), np.sin(0.6 * t)
    c, s = c * turn_c + s * turn_s, s * turn_c - c * turn_s
    radius: Array = np.ones_like(c * t)
    cosine, sine = c, s
    for even, odd in _LUMPS:
        cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        radius = radius + even * cosine + odd * sine
    return radius
