r"""How a straight piece ends that closes over a line, not over a pole: a cylinder that lies on its side.

::

      .----------------.      seen from above: the width goes to zero where the length does not
      |================|
      '----------------'

An ellipsoid's sections are all of one shape, so the squares of both their half axes reach zero together,
at its pole. Where the smaller one's does while the larger one's does not, the piece ends over a line. The
squares are quadratic in the depth for both, and for any quadric.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.end_model import distance_to_end
from stackloft.geometry.second_moments import central_moments
from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.sectioning.roof import TURNS, Thickness, closing_depth

LONG = 0.5
"""A line is at least this fraction of the outermost section's length squared."""
FEWEST = 3
BOUNDS = (0.5, 1.2)
"""Factors between which the length may go on beyond the outermost section."""


@dataclass(frozen=True, slots=True, eq=False)
class LineEnd:
    """A piece's outermost sections by their axes, outermost first."""

    across: FloatArray
    """(k,) mm²: second moment per area along the shorter axis"""
    along: FloatArray
    """(k,) mm²: along the longer axis"""
    depth: FloatArray
    """(k,) mm"""
    axes: FloatArray
    """(2, 2) rows: unit vectors across and along"""
    centres: FloatArray
    """(k, 2) mm"""

    def levels(self, length: float) -> list[tuple[float, FloatArray, FloatArray]]:
        """Return (distance beyond the outermost section, matrix, shift) that shape each level, outwards."""
        thickness = Thickness(np.sqrt(self.across), self.depth)
        drift = (self.centres[0] - self.centres[1]) / self.depth[1]
        found = []
        for turn in TURNS:
            part = float(np.cos(turn))
            distance = closing_depth(part, thickness, length)
            stretch = np.sqrt(_at(self.along, self.depth, -distance) / self.along[0])
            factors = np.array([part, np.clip(stretch, *BOUNDS)])
            matrix = self.axes.T @ (factors[:, None] * self.axes)
            found.append((distance, matrix, self.centres[0] + drift * distance - matrix @ self.centres[0]))
        return found


def line_end(followed: list[tuple[float, FloatArray]]) -> LineEnd | None:
    """Return how a piece closes over a line; None where a pole will do, as its areas reach zero in time.

    Parameters
    ----------
    followed : list of (z, polygon)
        Outermost first; polygons (k, 2) mm.
    """
    if len(followed) < FEWEST:
        return None
    depth = np.array([abs(z - followed[0][0]) for z, _ in followed])
    pitch = float(depth[1])
    area_root = distance_to_end(np.array([abs(polygon_area(p)) for _, p in followed]), depth)
    if area_root is not None and area_root <= pitch:
        return None
    moments = [central_moments(polygon) for _, polygon in followed]
    axes = np.linalg.eigh(moments[0][0])[1].T
    across, along = (np.array([axis @ matrix @ axis for matrix, _ in moments]) for axis in axes)
    root = distance_to_end(across, depth)
    if root is None or root > pitch or _at(along, depth, -root) < LONG * along[0]:
        return None
    return LineEnd(across, along, depth, axes, np.array([centre for _, centre in moments]))


def moved(loop: Loop, matrix: FloatArray, shift: FloatArray) -> Loop:
    """Return a loop mapped in its plane."""
    return Loop(loop.points @ matrix.T + shift, loop.corners, loop.hole)


def _at(values: FloatArray, depth: FloatArray, where: float) -> float:
    """Return the parabola through three values."""
    return float(np.polyval(np.polyfit(depth[:FEWEST], values[:FEWEST], 2), where))
