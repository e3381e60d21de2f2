"""Star-shaped bodies: X = stretch ∘ r(d)·d for every direction d.

::

            d
           /        r(d): how far the boundary lies along d, before the stretch
      ---o----
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.body import Body, Patch
from stackloft.testing.phantoms.dual import Array
from stackloft.testing.phantoms.quadrature import figures

_AWAY_FROM_ZERO = 1e-60


def direction(longitude: Array, latitude: Array) -> Array:
    """Return unit vectors (3, n)."""
    ring = np.cos(latitude)
    return np.stack([ring * np.cos(longitude), ring * np.sin(longitude), np.sin(latitude)])


def star_body(radius: Callable[[Array], Array], stretch: FloatArray, parameters: Mapping[str, float]) -> Body:
    """Return the body whose boundary is stretch ∘ radius(d)·d.

    Parameters
    ----------
    radius : callable
        Unit vectors (3, n) to distances (n), mm; analytic, positive.
    stretch : array (3)
        Factors along the axes.
    parameters : mapping
        What the body was made from.
    """
    factors = stretch[:, None]

    def surface(longitude: Array, latitude: Array) -> Array:
        d = direction(longitude, latitude)
        point: Array = factors * d * radius(d)
        return point

    def inside(X: Array) -> Array:
        Y = X / factors
        distance = np.sqrt((Y**2).sum(axis=0) + _AWAY_FROM_ZERO)
        value: Array = distance - radius(Y / distance)
        return value

    patches = (Patch(surface, (-np.pi, np.pi), (-np.pi / 2, np.pi / 2), ("periodic", "gauss")),)
    volume, area = figures(patches)
    return Body((inside,), patches, volume, area, parameters=parameters)
