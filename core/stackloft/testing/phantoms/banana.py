"""A banana: an elliptic tube about a circular arc, tapering to rounded ends."""

from __future__ import annotations

import numpy as np

from stackloft.testing.phantoms.body import Body, Patch
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array, arctan2
from stackloft.testing.phantoms.quadrature import figures


def banana(
    length: float = 140.0,
    thickness: float = 36.0,
    bend: float = 60.0,
    taper: float = 0.15,
    roundness: float = 0.9,
) -> Body:
    """Return a banana along z, bent in the x–z plane; every section across z is one loop.

    Its axis is an arc of `bend` degrees and of the given length. Across the axis it is an ellipse of
    half-width s(t) in the plane of the bend and roundness·s(t) across it, t from −1 to 1 along the arc,
    s² = (thickness/2)²·(1 − t²)·(1 + taper·t)².

    V = π·roundness·(thickness/2)²·(length/2)·(4/3 + 4/15·taper²): the tube's own centroid runs along its
    axis, so that bending leaves it (Pappus). S by quadrature.

    Parameters
    ----------
    length, thickness : float
        mm; the thickness less than the arc's radius.
    bend : float
        Degrees, 1 to 100.
    taper : float
        0 to 0.5.
    roundness : float
        0.5 to 1.5.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> fruit = phantoms.make("banana")
    >>> {len(fruit.section(z)) for z in fruit.positions(11)}
    {1}
    """
    positive(length=length, thickness=thickness)
    within(1, 100, bend=bend)
    within(0, 0.5, taper=taper)
    within(0.5, 1.5, roundness=roundness)
    given = {"length": length, "thickness": thickness, "bend": bend, "taper": taper, "roundness": roundness}
    half_angle, half = np.radians(bend) / 2, thickness / 2
    arc = length / 2 / half_angle
    within(0, 1.5 * arc, thickness=thickness)

    def surface(angle: Array, psi: Array) -> Array:
        t = np.sin(psi)
        s = half * np.cos(psi) * (1 + taper * t)
        out, alpha = arc + s * np.cos(angle), half_angle * t
        return np.stack([out * np.cos(alpha) - arc, roundness * s * np.sin(angle), out * np.sin(alpha)])

    def inside(X: Array) -> Array:
        x = X[0] + arc
        t = arctan2(X[2], x) / half_angle
        across = (np.sqrt(x**2 + X[2] ** 2) - arc) ** 2 + (X[1] / roundness) ** 2
        value: Array = across / half**2 - (1 - t**2) * (1 + taper * t) ** 2
        return value

    patches = (Patch(surface, (-np.pi, np.pi), (-np.pi / 2, np.pi / 2), ("periodic", "gauss")),)
    return Body(
        (inside,),
        patches,
        volume=np.pi * roundness * half**2 * length / 2 * (4 / 3 + 4 / 15 * taper**2),
        area=figures(patches)[1],
        parameters=given,
    )
