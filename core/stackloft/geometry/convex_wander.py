r"""How far the middles of a convex body's sections wander, by how their widths change.

::

     h(z)   ___            In any direction the two edges h of a convex body are concave in z (Brunn): a cut
      ____--   --__        between two others reaches at least as far as their chord. Where the middle bends,
     /    middle   \__     the width bends at least as much: second differences |m''| ≤ -w'' of middle and
    |---___---___-----|    half width. Laying a slice down elsewhere moves its middle, and leaves its width.
     \________________/

A tilted box, prism or cylinder has kinks of its middles wherever a cut passes one of its corners, and they
may alternate as displaced slices do; its widths tell them apart. Of bodies that are not convex the middles
may bend more; smoothly, as a bow does, which third differences do not see.

Brunn (1887), "Über Ovale und Eiflächen"; Gardner (2002), "The Brunn–Minkowski inequality", Bull. AMS 39, 355.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.roughness import NOISE, third_differences

FloatArray = NDArray[np.float64]

_DIRECTIONS = 12
"""Over half a turn."""


def unexplained_wander(position: FloatArray, polygons: Sequence[FloatArray]) -> FloatArray:
    """Return how far the middles of each four neighbours lie off any path of a convex body's, (m - 3).

    Parameters
    ----------
    position : array (m), increasing
    polygons : sequence of m arrays (k, 2)

    Returns
    -------
    array (m - 3)
        In the polygons' unit: root mean square over the directions, both components together, and scaled as
        third differences are: jitter of standard deviation s makes values of about s. Never negative.

    Examples
    --------
    >>> z = np.arange(8.0)
    >>> square = np.array([[-9.0, -9], [9, -9], [9, 9], [-9, 9]])
    >>> bent = [square + [abs(at - 3.5), 0] for at in z]       # as no convex body of one width is
    >>> wedge = [square * [2 - abs(at - 3.5) / 4, 1] + [abs(at - 3.5), 0] for at in z]
    >>> bool(unexplained_wander(z, bent).max() > 0.2), bool(unexplained_wander(z, wedge).max() < 1e-9)
    (True, True)
    """
    middle, half = _edges(polygons, _directions())
    bend = np.abs(_second_divided(position, half))
    reach = (position[3:] - position[:-3])[:, None]
    centred = (position - position.mean())[:, None]
    scale = third_differences(position, centred**3)  # of a third divided difference of one
    allowed = scale * (bend[:-1] + bend[1:]) / reach
    left = np.maximum(np.abs(third_differences(position, middle)) - allowed, 0.0)
    wander: FloatArray = np.sqrt(2 * (left**2).mean(axis=1)) / NOISE
    return wander


def explained_displacement(
    position: FloatArray, polygons: Sequence[FloatArray], displaced: NDArray[np.bool_], direction: FloatArray
) -> float:
    """Return the longest displacement of some sections that a convex body so wide may show by itself.

    Parameters
    ----------
    position : array (m), increasing
    polygons : sequence of m arrays (k, 2)
    displaced : array (m) of bool
        The sections that lie beside the others.
    direction : array (2)
        Of unit length: whereto.

    Examples
    --------
    >>> z, t = np.arange(8.0), np.linspace(0, 2 * np.pi, 400, endpoint=False)
    >>> disc = np.column_stack([np.cos(t), np.sin(t)])
    >>> ball = [np.sqrt(25 - (at - 3.5) ** 2) * disc for at in z]
    >>> round(explained_displacement(z, ball, z > 3, np.array([1.0, 0.0])), 2)      # its bend, 1 / radius
    0.21
    """
    _, half = _edges(polygons, direction[:, None])
    bend = np.abs(_second_divided(position, half)[:, 0])
    made = np.abs(_second_divided(position, displaced.astype(np.float64)[:, None])[:, 0])
    concerned = made > 0
    return float((bend[concerned] / made[concerned]).min(initial=np.inf))


def _directions() -> FloatArray:
    angle = np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    return np.array([np.cos(angle), np.sin(angle)])


def _edges(polygons: Sequence[FloatArray], directions: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the middles between the two edges and the half widths in `directions` (2, n), both (m, n)."""
    reaches = [polygon @ directions for polygon in polygons]
    far = np.array([reach.max(axis=0) for reach in reaches])
    near = np.array([reach.min(axis=0) for reach in reaches])
    return (far + near) / 2, (far - near) / 2


def _second_divided(position: FloatArray, values: FloatArray) -> FloatArray:
    slopes = np.diff(values, axis=0) / np.diff(position)[:, None]
    second: FloatArray = np.diff(slopes, axis=0) / (position[2:] - position[:-2])[:, None]
    return second
