"""An apple: a shallow dimple at the stem and at the calyx, five faint ribs, its axis in the picture."""

from __future__ import annotations

import numpy as np

from stackloft.testing.phantoms.body import Body
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.star_body import star_body

_DIMPLE = 0.09
_RIBS = 0.008


def apple(
    diameter: float = 80.0,
    stem: float = 0.22,
    calyx: float = 0.14,
    taper: float = 0.06,
    flatness: float = 0.95,
) -> Body:
    """Return an apple whose axis is y, so that sections across z are cut along the core and all filled.

    With c the cosine of the angle to the axis, the distance from the centre is
    R·(1 + taper·c − stem·e^(−(1−c)/w) − calyx·e^(−(1+c)/w) + ribs·sin⁵·cos 5φ), w = 0.09, and the body is
    pressed to `flatness` of its thickness along z, so that a slice is never quite round.

    Parameters
    ----------
    diameter : float
        About the greatest width, mm.
    stem, calyx : float
        Depths of the dimples over the radius, 0 to 0.35.
    taper : float
        How much broader the stem's half is, 0 to 0.15.
    flatness : float
        0.7 to 1.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> body = phantoms.make("apple")
    >>> {len(body.section(z)) for z in body.positions(15)}
    {1}
    """
    positive(diameter=diameter)
    within(0, 0.35, stem=stem, calyx=calyx)
    within(0, 0.15, taper=taper)
    within(0.7, 1, flatness=flatness)

    def distance(d: Array) -> Array:
        c = d[1]
        ribs = d[2] ** 5 - 10 * d[2] ** 3 * d[0] ** 2 + 5 * d[2] * d[0] ** 4
        dimples = stem * np.exp(-(1 - c) / _DIMPLE) + calyx * np.exp(-(1 + c) / _DIMPLE)
        r: Array = diameter / 2 * (1 + taper * c - dimples + _RIBS * ribs)
        return r

    return star_body(
        distance,
        np.array([1.0, 0.95, flatness]),
        {"diameter": diameter, "stem": stem, "calyx": calyx, "taper": taper, "flatness": flatness},
    )
