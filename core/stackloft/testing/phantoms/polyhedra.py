"""Box and square prism."""

from __future__ import annotations

from itertools import product

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.body import Body, Patch, Plane
from stackloft.testing.phantoms.checks import positive
from stackloft.testing.phantoms.dual import Array


def box(a: float = 60.0, b: float = 40.0, c: float = 80.0) -> Body:
    """Return the box with edges a, b, c (mm) along x, y, z, centred on the origin.

    Examples
    --------
    >>> box(1, 2, 3).volume, box(1, 2, 3).area
    (6, 22)
    """
    positive(a=a, b=b, c=c)
    half = np.array([a, b, c]) / 2
    sides = [(axis, sign) for axis in range(3) for sign in (1.0, -1.0)]
    return Body(
        fields=tuple(Plane(sign * np.eye(3)[axis], float(half[axis])) for axis, sign in sides),
        patches=tuple(_side(half, axis, sign) for axis, sign in sides),
        volume=a * b * c,
        area=2 * (a * b + b * c + c * a),
        tips=np.array([half * signs for signs in product((1, -1), repeat=3)]),
        parameters={"a": a, "b": b, "c": c},
    )


def prism(side: float = 50.0, height: float = 80.0) -> Body:
    """Return the square prism of the given side and height (mm), its axis along z.

    Examples
    --------
    >>> prism(2, 5).volume
    20
    """
    return box(side, side, height)


def _side(half: FloatArray, axis: int, sign: float) -> Patch:
    i, j = (axis + 1) % 3, (axis + 2) % 3

    def surface(u: Array, v: Array) -> Array:
        point = np.zeros((3, *u.shape), dtype=np.result_type(u, v))
        point[axis], point[i], point[j] = sign * half[axis], sign * half[i] * u, half[j] * v
        return point

    return Patch(surface, (-1, 1), (-1, 1))
