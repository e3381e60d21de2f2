r"""Corners of exact loops: vertices where the outline itself turns, not the chords of a curve.

::

      o----o----o        box: 90° at four vertices, 0° at the others: corners
      |         |
      o----o----o           _o-o_
                           o     o      circle: the same small turn at every vertex: none
                            \o-o/

A vertex of a smooth curve turns about as much as its neighbours, and the less the denser the loop; a
corner turns at once.
"""

from __future__ import annotations

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray, frozen_ints

POLYGON = 8
"""A loop with no more vertices is a polygon as it stands; nobody digitises a curve with so few."""

TURN = 40.0
"""Degrees: a vertex of a denser loop that turns less is no corner (a regular 9-gon turns by 40°)."""

MOST = 16
"""More corners than this are the steps of a pixel outline, and no corners at all."""

_ALONE = 5.0  # a corner turns this many times as much as the smooth vertices beside it
_STRAIGHT = 5.0  # degrees: a polygon's vertex that turns less lies on a side


def polygon_corners(points: FloatArray) -> IntArray:
    """Return the numbers of the vertices that are corners.

    - With at most 8 vertices: all that turn by more than 5°.
    - With more: those that turn by more than 40° and five times as much as the nearest vertex on either
      side that does not. Ellipses of 12 points up to an axis ratio of 3 and of 33 points up to 6 have none.

    Parameters
    ----------
    points : ndarray, (k, 2)
        Closed loop in order, no two consecutive vertices equal.

    Examples
    --------
    >>> polygon_corners(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]))
    array([0, 1, 2, 3])
    >>> angle = np.arange(12) * np.pi / 6
    >>> polygon_corners(np.column_stack([np.cos(angle), np.sin(angle)])).size
    0
    """
    turn = np.abs(turning_degrees(points))
    if len(points) <= POLYGON:
        return frozen_ints(np.flatnonzero(turn > _STRAIGHT))
    sharp = turn > TURN + 1e-9
    if not sharp.any():
        return frozen_ints([])
    if sharp.all():
        return frozen_ints(np.flatnonzero(sharp) if len(points) <= MOST else [])
    smooth = np.where(sharp, np.nan, turn)
    before, after = _last_known(smooth), _last_known(smooth[::-1])[::-1]
    corners = np.flatnonzero(sharp & (turn >= _ALONE * before) & (turn >= _ALONE * after))
    return frozen_ints(corners if len(corners) <= MOST else [])


def turning_degrees(points: FloatArray) -> FloatArray:
    """Return the signed turn of a closed polygon at each vertex, −180 to 180 degrees.

    Examples
    --------
    >>> turning_degrees(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]))
    array([90., 90., 90., 90.])
    """
    ahead = np.roll(points, -1, axis=0) - points
    behind = np.roll(ahead, 1, axis=0)
    cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
    degrees: FloatArray = np.degrees(np.arctan2(cross, np.sum(behind * ahead, axis=1)))
    return degrees


def _last_known(values: FloatArray) -> FloatArray:
    """Return, around a ring with some NaN, each entry's nearest known value at or before it."""
    ring = np.concatenate([values, values])
    known = np.where(np.isnan(ring), -1, np.arange(len(ring)))
    return ring[np.maximum.accumulate(known)][len(values) :]
