"""What theory says of a method's order of convergence, and of Cavalieri's error on an ellipsoid.

Cavalieri at mid-thickness is the midpoint rule on A(z): order 2 where A is smooth up to the ends. On an
ellipsoid A is a parabola, A₀(1 − t²) with t from −1 to 1, and m sections err by exactly +1/(2m²) in any pose:
Σ (1 − t_k²)·2/m = 4/3 + 2/(3m²) against 4/3.

Frustums stop at the outermost sections, half a pitch h/2 before the end: with a plane face they lose volume
of order h, at a round end h·A(h) ~ h², at a point ~ h³, less than the h² of the cones between sections.

The loft is a cubic interpolation along and across (de Boor 2001, A Practical Guide to Splines, ch. V):
order 4 where the surface is smooth. Beyond the outermost section lies half a pitch h/2 up to the pole, and
that cap is similar to itself whatever h: its relative error stays, its share of the volume goes with h² at a
round end (A ∝ depth) and with h³ at a point (A ∝ depth²). So the loft's order in sections is 4 between plane
faces, 3 with a point, 2 with a round end, where the constant is small.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from stackloft.studies.accuracy_bodies import AccuracyBody

_ORDERS: Mapping[tuple[str, str], float] = MappingProxyType(
    {
        ("loft", "points"): 4.0,
        ("cavalieri", "sections"): 2.0,
        ("voxel", "sections"): 2.0,
        ("partial-volume", "sections"): 2.0,
        ("loft", "pixel"): 2.0,
        ("cavalieri", "pixel"): 2.0,
        ("voxel", "pixel"): 2.0,
    }
)
"""(method, axis) to the order of the volume's error on smooth bodies."""
_BY_END: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        "loft": {"face": 4.0, "point": 3.0, "round": 2.0},
        "frustum": {"face": 1.0, "point": 2.0, "round": 2.0},
    }
)
"""Method to the order in sections by the kind of end; with two kinds the lower one rules."""


def order_of(method: str, axis: str, ending: str = "round") -> float | None:
    """Return the order that theory gives the volume's error, None where none is stated.

    Parameters
    ----------
    method, axis : str
    ending : str
        How the body ends: ``round``, ``point``, ``face``, or two of them with a slash.

    Examples
    --------
    >>> order_of("frustum", "sections"), order_of("frustum", "sections", "face")
    (2.0, 1.0)
    """
    if axis == "sections" and method in _BY_END:
        known = _BY_END[method]
        orders = [known[kind] for kind in ending.split("/") if kind in known]
        return min(orders) if orders else None
    return _ORDERS.get((method, axis))


def expected_volume_error(method: str, axis: str, body: AccuracyBody, sections: int) -> float | None:
    """Return the volume's error, %, where theory fixes it: Cavalieri on an ellipsoid at mid-thickness.

    Examples
    --------
    >>> from stackloft.studies.accuracy_bodies import BODIES
    >>> expected_volume_error("cavalieri", "sections", BODIES[0], 10)
    0.5
    """
    if method == "cavalieri" and axis == "sections" and body.ellipsoid:
        return 100.0 / (2.0 * sections**2)
    return None
