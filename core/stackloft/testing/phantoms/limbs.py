r"""Round bars that branch or bend: a Y with three limbs, a horseshoe.

::

     (\     /)        .-----.       one bar radius; ends are half balls
       \\ //         /  .-.  \
        | |         |  |   |  |     where limbs meet, each keeps what is nearest to its own axis:
        | |         |  |   `--'     on the bisecting planes the boundary has a valley
        `-'         `--'
"""

from __future__ import annotations

import math

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.body import Body, Patch
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.rings import torus_field
from stackloft.testing.phantoms.round_bars import bar_field, cap_patch, frame_of, side_patch

_OUT = np.array([0.0, 1.0, 0.0])
"""Across the plane in which the limbs lie."""


def y_branch(
    radius: float = 11.0,
    trunk: float = 42.0,
    left: float = 40.0,
    right: float = 33.0,
    left_angle: float = 38.0,
    right_angle: float = 50.0,
    mirror: int = 0,
) -> Body:
    """Return a Y: a trunk downwards and two arms upwards, all round bars of one radius, in the x–z plane.

    With limbs of axis lengths L_i from the common point and angles θ between neighbours,
    V = Σ (π·r²·L_i + 2/3·π·r³) − 4/3·r³·Σ cot(θ/2), S = Σ (2π·r·L_i + 2π·r²) − 4·r²·Σ cot(θ/2): between
    two limbs the bisecting plane cuts t·cot(θ/2) off both at the distance t from the axis.

    Parameters
    ----------
    radius, trunk, left, right : float
        The bars' radius and the lengths of their axes, mm.
    left_angle, right_angle : float
        How far the arms lean from the vertical, degrees, 20 to 90.
    mirror : int
        1: the mirror image, left and right exchanged.

    Examples
    --------
    >>> y_branch().volume == y_branch(mirror=1).volume
    True
    """
    positive(radius=radius, trunk=trunk, left=left, right=right)
    within(20, 90, left_angle=left_angle, right_angle=right_angle)
    sign = -1.0 if mirror else 1.0
    bearings = [180.0, -sign * left_angle, sign * right_angle]  # from up towards x
    lengths = [trunk, left, right]
    order = np.argsort(bearings)
    limbs = [(math.radians(bearings[i]), lengths[i]) for i in order]
    gaps = [(limbs[(i + 1) % 3][0] - limbs[i][0]) % (2 * math.pi) for i in range(3)]
    cots = [1 / math.tan(gap / 2) for gap in gaps]
    within(max(cots[0], cots[1], cots[2]) * radius, math.inf, trunk=trunk, left=left, right=right)
    fields, patches = [], []
    for i, (bearing, length) in enumerate(limbs):
        axis = np.array([math.sin(bearing), 0.0, math.cos(bearing)])
        fields.append(bar_field(np.zeros(3), axis, length, radius))
        patches += _limb(axis, length, radius, (cots[i], cots[i - 1]))
    total, valleys = sum(lengths), sum(cots)
    return Body(
        fields=tuple(fields),
        patches=tuple(patches),
        volume=math.pi * radius**2 * (total + 2 * radius) - 4 / 3 * radius**3 * valleys,
        area=2 * math.pi * radius * (total + 3 * radius) - 4 * radius**2 * valleys,
        parameters={
            "radius": radius,
            "trunk": trunk,
            "left": left,
            "right": right,
            "left_angle": left_angle,
            "right_angle": right_angle,
            "mirror": mirror,
        },
        parts=((0,), (1,), (2,)),
        detail=241,
    )


def _limb(axis: FloatArray, length: float, radius: float, cots: tuple[float, float]) -> list[Patch]:
    """Return a limb's side towards its next and its previous neighbour, and its round end."""
    toward = np.cross(_OUT, axis)
    patches = [cap_patch(length * axis, frame_of(axis, toward), radius)]
    for cot, first in zip(cots, (toward, -toward), strict=True):

        def begin(angle: Array, cot: float = cot) -> Array:
            s: Array = radius * cot * np.cos(angle)
            return s

        patches.append(
            side_patch(np.zeros(3), frame_of(axis, first), radius, (begin, length), (-np.pi / 2, np.pi / 2))
        )
    return patches


def horseshoe(bend: float = 28.0, radius: float = 10.0, left: float = 38.0, right: float = 26.0) -> Body:
    """Return a round bar bent to half a circle, with straight legs of unequal length and round ends.

    The bend's axis is a half circle of radius `bend` in the x–z plane, open downwards; the legs' axes go
    down from (∓bend, 0, 0). V = π·r²·L + 4/3·π·r³, S = 2π·r·L + 4π·r² with L = π·bend + left + right
    (Pappus).

    Examples
    --------
    >>> body = horseshoe(3, 1, 2, 2)
    >>> round(body.volume / np.pi, 9) == round(3 * np.pi + 4 + 4 / 3, 9)
    True
    """
    positive(bend=bend, radius=radius, left=left, right=right)
    within(0, 0.95 * bend, radius=radius)
    arc = torus_field(bend, radius)
    down = np.array([0.0, 0.0, -1.0])
    feet = [(np.array([-bend, 0.0, 0.0]), left), (np.array([bend, 0.0, 0.0]), right)]
    legs = [bar_field(foot, down, length, radius) for foot, length in feet]

    def value(X: Array) -> Array:
        below = np.where(X[0].real < 0, legs[0](X), legs[1](X))
        distance: Array = np.where(X[2].real < 0, below, arc(np.stack([X[0], X[2], X[1]])))
        return distance

    def surface(along: Array, around: Array) -> Array:
        rho = bend + radius * np.cos(around)
        return np.stack([rho * np.cos(along), -radius * np.sin(around), rho * np.sin(along)])

    patches = [Patch(surface, (0.0, np.pi), (-np.pi, np.pi), ("gauss", "periodic"))]
    frame = frame_of(down, np.array([1.0, 0.0, 0.0]))
    for foot, length in feet:
        patches.append(side_patch(foot, frame, radius, (lambda angle: 0 * angle, length)))
        patches.append(cap_patch(foot + length * down, frame, radius))
    total = math.pi * bend + left + right
    return Body(
        fields=(value,),
        patches=tuple(patches),
        volume=math.pi * radius**2 * (total + 4 / 3 * radius),
        area=2 * math.pi * radius * (total + 2 * radius),
        parameters={"bend": bend, "radius": radius, "left": left, "right": right},
        detail=241,
    )
