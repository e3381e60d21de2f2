r"""Pieces of round bars: the distance from a straight axis, straight sides and round ends.

::

      a ^      .--------------------.
        |     |                      )      the side is |X − axis| = r, the cap half a ball
        P ----|------ axis --------> )
              `--------------------`
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.body import Field, Patch
from stackloft.testing.phantoms.dual import Array

_AWAY_FROM_ZERO = 1e-60


def length_of(V: Array) -> Array:
    """Return the Euclidean lengths of vectors (3, n), or of (2, n), real or complex."""
    lengths: Array = np.sqrt((V**2).sum(axis=0) + _AWAY_FROM_ZERO)
    return lengths


def bar_field(start: FloatArray, axis: FloatArray, length: float, radius: float) -> Field:
    """Return the field of a straight bar with round ends: distance from its axis less the radius.

    Examples
    --------
    >>> bar = bar_field(np.zeros(3), np.array([0.0, 0, 1]), 5.0, 2.0)
    >>> bar(np.array([[3.0, 0], [0, 0], [2, 9]])).tolist()
    [1.0, 2.0]
    """

    def value(X: Array) -> Array:
        Y = X - start[:, None]
        s = axis @ Y
        s = np.where(s.real < 0, 0, np.where(s.real > length, length, s))
        distance: Array = length_of(Y - axis[:, None] * s) - radius
        return distance

    return value


def frame_of(axis: FloatArray, first: FloatArray) -> FloatArray:
    """Return the right-handed frame (a, b, axis) as rows, a being `first` (across the axis)."""
    return np.stack([first, np.cross(axis, first), axis])


def cap_patch(centre: FloatArray, frame: FloatArray, radius: float) -> Patch:
    """Return half a ball about `centre`, on the side of the frame's axis."""

    def surface(longitude: Array, latitude: Array) -> Array:
        ring = radius * np.cos(latitude)
        local = np.stack([ring * np.cos(longitude), ring * np.sin(longitude), radius * np.sin(latitude)])
        point: Array = centre[:, None] + frame.T @ local
        return point

    return Patch(surface, (-np.pi, np.pi), (0.0, np.pi / 2), ("periodic", "gauss"))


def side_patch(
    start: FloatArray,
    frame: FloatArray,
    radius: float,
    span: tuple[Callable[[Array], Array], float],
    angles: tuple[float, float] = (-np.pi, np.pi),
) -> Patch:
    """Return a bar's side from where `span[0]`(angle) says to `span[1]` along the axis, mm."""
    low, high = span

    def surface(angle: Array, t: Array) -> Array:
        s = low(angle) * (1 - t) + high * t
        local = np.stack([radius * np.cos(angle), radius * np.sin(angle), s])
        point: Array = start[:, None] + frame.T @ local
        return point

    whole = angles[1] - angles[0] > 6.28
    return Patch(surface, angles, (0.0, 1.0), ("periodic" if whole else "gauss", "gauss"))
