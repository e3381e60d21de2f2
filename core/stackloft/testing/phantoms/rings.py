r"""A torus; a torus with a limb."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from stackloft.testing.phantoms.body import Body, Field, Patch
from stackloft.testing.phantoms.checks import positive, within
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.quadrature import nodes_and_weights
from stackloft.testing.phantoms.round_bars import (
    bar_field,
    cap_patch,
    frame_of,
    length_of,
    side_patch,
)

_X = np.array([1.0, 0.0, 0.0])


def torus(ring: float = 30.0, radius: float = 12.0) -> Body:
    """Return the torus about z whose tube of `radius` has its centre on a circle of radius `ring`, mm.

    V = 2π²·ring·radius², S = 4π²·ring·radius (Pappus). Cut across its axis its sections are rings that close
    over two ridges; cut along it, two discs that merge into a ring and part again.

    Examples
    --------
    >>> round(torus(3, 1).volume / np.pi**2, 12), round(torus(3, 1).area / np.pi**2, 12)
    (6.0, 12.0)
    """
    positive(ring=ring, radius=radius)
    within(0, 0.99 * ring, radius=radius)
    return Body(
        fields=(torus_field(ring, radius),),
        patches=(
            Patch(_torus_surface(ring, radius), (-np.pi, np.pi), (-np.pi, np.pi), ("periodic", "periodic")),
        ),
        volume=2 * math.pi**2 * ring * radius**2,
        area=4 * math.pi**2 * ring * radius,
        parameters={"ring": ring, "radius": radius},
        detail=181,
    )


def ring_with_branch(
    ring: float = 28.0, radius: float = 11.0, limb: float = 7.5, reach: float = 34.0
) -> Body:
    """Return a torus about z with a round limb along x: a ring with a branch.

    The limb's tube of radius `limb` < `radius` grows out of the ring at (ring, 0, 0) and ends in half a ball
    whose top lies `reach` beyond the ring's outside. Over the limb's own disc the torus is the graph
    x = √((ring + √(radius² − z²))² − y²): what it loses there, and where the limb begins, are integrals over
    that disc.

    Examples
    --------
    >>> body = ring_with_branch()
    >>> bool(body.volume > torus(28, 11).volume), len(body.parts)
    (True, 2)
    """
    positive(ring=ring, radius=radius, limb=limb, reach=reach)
    within(0, 0.9 * ring, radius=radius)
    within(0, 0.9 * radius, limb=limb)
    within(limb, math.inf, reach=reach)
    end = ring + radius + reach - limb

    def begin(y: Array, z: Array) -> Array:
        x: Array = np.sqrt((ring + np.sqrt(radius**2 - z**2)) ** 2 - y**2)
        return x

    def rim(angle: Array) -> Array:
        return begin(limb * np.cos(angle), limb * np.sin(angle)) - ring

    start = np.array([ring, 0.0, 0.0])
    frame = frame_of(_X, np.array([0.0, 1.0, 0.0]))
    lost, under = _disc_integrals(ring, radius, limb)
    return Body(
        fields=(torus_field(ring, radius), bar_field(start, _X, end - ring, limb)),
        patches=(
            *_opened_torus(ring, radius, limb),
            side_patch(start, frame, limb, (rim, end - ring)),
            cap_patch(np.array([end, 0.0, 0.0]), frame, limb),
        ),
        volume=2 * math.pi**2 * ring * radius**2
        + (math.pi * limb**2 * end - under)
        + 2 / 3 * math.pi * limb**3,
        area=4 * math.pi**2 * ring * radius
        - lost
        + _limb_side(rim, end - ring, limb)
        + 2 * math.pi * limb**2,
        parameters={"ring": ring, "radius": radius, "limb": limb, "reach": reach},
        parts=((0,), (1,)),
        detail=241,
    )


def torus_field(ring: float, radius: float) -> Field:
    """Return the distance from a circle about z less the tube's radius."""

    def value(X: Array) -> Array:
        distance: Array = length_of(np.stack([length_of(X[:2]) - ring, X[2]])) - radius
        return distance

    return value


def _torus_surface(ring: float, radius: float) -> Callable[[Array, Array], Array]:
    def surface(along: Array, around: Array) -> Array:
        rho = ring + radius * np.cos(around)
        return np.stack([rho * np.cos(along), rho * np.sin(along), radius * np.sin(around)])

    return surface


def _disc_integrals(ring: float, radius: float, limb: float) -> tuple[float, float]:
    """Return the torus' area over the limb's disc, mm², and the volume between that disc at x = 0 and it."""
    angle, wa = nodes_and_weights("periodic", 240, (-np.pi, np.pi))
    r, wr = nodes_and_weights("gauss", 320, (0.0, limb))
    A, Rr = (grid.ravel() for grid in np.meshgrid(angle, r, indexing="ij"))
    weights = np.outer(wa, wr).ravel() * Rr
    y, z = Rr * np.cos(A), Rr * np.sin(A)
    rise = np.sqrt(radius**2 - z**2)
    rho = ring + rise
    x = np.sqrt(rho**2 - y**2)
    slope_y, slope_z = -y / x, -rho * z / (rise * x)
    return float(weights @ np.sqrt(1 + slope_y**2 + slope_z**2)), float(weights @ x)


def _limb_side(rim: Callable[[Array], Array], end: float, limb: float) -> float:
    angle, w = nodes_and_weights("periodic", 480, (-np.pi, np.pi))
    return float(limb * w @ (end - rim(angle)))


def _opened_torus(ring: float, radius: float, limb: float) -> tuple[Patch, ...]:
    """Return the torus less the limb's opening: a square about it in the angles in four parts; the rest."""
    whole = _torus_surface(ring, radius)
    half = min(1.4 * math.asin(limb / (ring + math.sqrt(radius**2 - limb**2))), 3.0)

    def quarter(k: int) -> Patch:
        turn = k * math.pi / 2

        def surface(w: Array, t: Array) -> Array:
            angle = turn + w
            around = np.arcsin(limb * np.sin(angle) / radius)
            along = np.arcsin(limb * np.cos(angle) / (ring + radius * np.cos(around)))
            side = np.stack([1 + 0 * w, np.tan(w)])
            c, s = round(math.cos(turn)), round(math.sin(turn))
            far = np.stack([half * (c * side[0] - s * side[1]), math.pi * (s * side[0] + c * side[1])])
            return whole((1 - t) * along + t * far[0], (1 - t) * around + t * far[1])

        return Patch(lambda t, w: surface(w, t), (0.0, 1.0), (-math.pi / 4, math.pi / 4))

    rest = Patch(whole, (half, 2 * math.pi - half), (-math.pi, math.pi), ("gauss", "periodic"))
    return (*(quarter(k) for k in range(4)), rest)
