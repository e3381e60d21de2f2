"""Ellipsoid and superellipsoid."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
from scipy.special import beta, elliprg, gamma

from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.body import Body, Field, Patch
from stackloft.testing.phantoms.checks import positive
from stackloft.testing.phantoms.dual import Array, power_abs, power_signed
from stackloft.testing.phantoms.quadrature import figures
from stackloft.testing.phantoms.star_body import direction


def ellipsoid(a: float = 32.0, b: float = 25.0, c: float = 41.0) -> Body:
    """Return the ellipsoid of semi-axes a, b, c (mm): x²/a² + y²/b² + z²/c² ≤ 1.

    V = 4π/3·abc; S = 4π·R_G(a²b², b²c², c²a²) with Carlson's symmetric integral (DLMF 19.33.2).

    Examples
    --------
    >>> round(ellipsoid(1, 1, 1).area / np.pi, 12)
    4.0
    """
    positive(a=a, b=b, c=c)
    axes = np.array([[a], [b], [c]])
    return Body(
        fields=(lambda X: ((X / axes) ** 2).sum(axis=0) - 1,),
        patches=(
            Patch(
                lambda u, v: axes * direction(u, v),
                (-np.pi, np.pi),
                (-np.pi / 2, np.pi / 2),
                ("periodic", "gauss"),
            ),
        ),
        volume=4 / 3 * np.pi * a * b * c,
        area=float(4 * np.pi * elliprg((a * b) ** 2, (b * c) ** 2, (c * a) ** 2)),
        parameters={"a": a, "b": b, "c": c},
    )


def superellipsoid(a: float = 32.0, b: float = 25.0, c: float = 41.0, p: float = 2.5, n: float = 2.0) -> Body:
    """Return the superellipsoid (|x/a|^n + |y/b|^n)^(p/n) + |z/c|^p ≤ 1.

    Its sections across z are Lamé curves of in-plane exponent n; its meridians have the axial exponent
    p: p = 2 ends like an ellipsoid, p = 4 blunt, p = 1 in a point (n = 2, p = 1: the double cone).

    V = 4·Γ(1+1/n)²/Γ(1+2/n) · abc · (2/p)·B(1/p, 1+2/p); S by tanh-sinh quadrature of one octant.

    Parameters
    ----------
    a, b, c : float
        Semi-axes, mm.
    p, n : float
        Axial and in-plane exponent, at least 1: below 1 the body is cusped and not a body that is sliced.

    Examples
    --------
    >>> body = superellipsoid(1, 1, 1, p=1, n=1)  # the octahedron
    >>> round(body.volume, 9), round(body.area, 9)
    (1.333333333, 6.92820323)
    """
    positive(a=a, b=b, c=c)
    if min(p, n) < 1 or max(p, n) > 40:
        raise UsageError(
            "exponents outside the range",
            where="superellipsoid",
            found=f"p={p:g}, n={n:g}",
            expected="1 to 40",
        )
    octants = tuple(_octant((a, b, c), (p, n), np.array(signs)) for signs in product((1, -1), repeat=3))
    lame = 4 * gamma(1 + 1 / n) ** 2 / gamma(1 + 2 / n)
    return Body(
        fields=_fields((a, b, c), p, n),
        patches=octants,
        volume=float(lame * a * b * c * 2 / p * beta(1 / p, 1 + 2 / p)),
        area=8 * figures(octants[:1])[1],
        tips=_tips((a, b, c), p, n),
        parameters={"a": a, "b": b, "c": c, "p": p, "n": n},
    )


def double_cone(radius: float = 30.0, height: float = 80.0) -> Body:
    """Return two cones on one base circle, tip to tip `height` mm.

    V = π·r²·h/3, S = 2π·r·√(r² + h²/4).

    Examples
    --------
    >>> round(double_cone(3, 8).area / np.pi, 9)
    30.0
    """
    positive(radius=radius, height=height)
    body = superellipsoid(radius, radius, height / 2, p=1, n=2)
    return Body(
        body.fields,
        body.patches,
        volume=np.pi * radius**2 * height / 3,
        area=2 * np.pi * radius * float(np.hypot(radius, height / 2)),
        tips=body.tips,
        parameters={"radius": radius, "height": height},
    )


def _octant(axes: tuple[float, float, float], exponents: tuple[float, float], signs: Array) -> Patch:
    """Return the octant of the given signs: each direction scaled onto the boundary."""
    (p, n), factors = exponents, (np.array(axes) * signs)[:, None]
    mirrored = signs.prod() < 0

    def surface(longitude: Array, latitude: Array) -> Array:
        d = direction(np.pi / 2 - longitude if mirrored else longitude, latitude)
        in_plane = power_abs(power_abs(d[0], n) + power_abs(d[1], n), p / n) if n > 1 else (d[0] + d[1]) ** p
        point: Array = factors * d * (in_plane + power_abs(d[2], p)) ** (-1 / p)
        return point

    return Patch(surface, (0, np.pi / 2), (0, np.pi / 2), ("graded", "graded"))


def _fields(axes: tuple[float, float, float], p: float, n: float) -> tuple[Field, ...]:
    """Return smooth fields whose maximum is the body: one, or one per sign where an exponent is 1."""
    a, b, c = axes

    def rounded(X: Array) -> Array:
        return power_abs(power_abs(X[0] / a, n) + power_abs(X[1] / b, n), 1 / n)

    def flat(s: float, t: float) -> Callable[[Array], Array]:
        return lambda X: s * X[0] / a + t * X[1] / b

    in_plane = [rounded] if n > 1 else [flat(s, t) for s, t in product((1, -1), repeat=2)]
    if p > 1:
        return tuple(_sum(radius, p, lambda X: power_abs(X[2] / c, p)) for radius in in_plane)
    return tuple(
        _sum(radius, 1, axial) for radius in in_plane for axial in (lambda X: X[2] / c, lambda X: -X[2] / c)
    )


def _sum(radius: Callable[[Array], Array], p: float, axial: Callable[[Array], Array]) -> Field:
    return lambda X: power_signed(radius(X), p) + axial(X) - 1


def _tips(axes: tuple[float, float, float], p: float, n: float) -> Array:
    a, b, c = axes
    tips = [[0, 0, c], [0, 0, -c]] if p == 1 else []
    tips += [[a, 0, 0], [-a, 0, 0], [0, b, 0], [0, -b, 0]] if p == 1 and n == 1 else []
    return np.array(tips, dtype=float).reshape(-1, 3)
