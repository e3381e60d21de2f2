"""The nearest point of exact curves: rims, and the lines where a surface turns sharply."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.exact_surface import ExactSurface, Feet

FloatArray = NDArray[np.float64]


class CurveSet:
    """Cubic Bézier curves that points are projected on: rims, creases, corner lines.

    Parameters
    ----------
    segments : (k, 4, 3) array
        Control points, mm.

    Examples
    --------
    >>> line = np.linspace([0.0, 0.0, 0.0], [3.0, 0.0, 0.0], 4)[None]
    >>> CurveSet(line).project(np.array([[1.2, 4.0, 0.0]])).points.round(9).tolist()
    [[1.2, 0.0, 0.0]]
    """

    def __init__(self, segments: FloatArray) -> None:
        self.segments = segments.reshape(-1, 4, 3)
        # a curve is a patch that does not change along v
        self._surface = ExactSurface(np.repeat(self.segments[:, None], 4, axis=1))

    def project(self, points: FloatArray) -> Feet:
        """Return the nearest point of the curves for each of `points` (n, 3)."""
        feet = self._surface.project(points)
        return Feet(feet.points, feet.patch, feet.at[:, 1:], feet.distance)
