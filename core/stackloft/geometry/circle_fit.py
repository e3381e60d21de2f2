"""The circle nearest to points, by Gauss–Newton on the distances, without points far off it.

Geometric fit as in Gander, Golub & Strebel (1994), "Least-squares fitting of circles and ellipses",
BIT 34, 558–578.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_ROUNDS = 12
_SETTLED = 1e-12
_FAR = 3.0  # standard deviations


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle, and how well points lie on it; lengths in the points' unit."""

    x: float
    y: float
    radius: float
    spread: float
    """Standard deviation of the points' distances from it."""
    oblique: float
    """How much longer than its shortest diameter the longest one is, relative: what a tilted camera makes."""


def fit_circle(points: FloatArray) -> Circle:
    """Return the circle through points that lie all around it.

    Parameters
    ----------
    points : array (k, 2), k ≥ 8

    Examples
    --------
    >>> t = np.linspace(0, 6.2, 40)
    >>> circle = fit_circle(np.column_stack([3 + 5 * np.cos(t), 4 + 5 * np.sin(t)]))
    >>> round(circle.x, 9), round(circle.y, 9), round(circle.radius, 9)
    (3.0, 4.0, 5.0)
    """
    centre = points.mean(axis=0)
    radius = float(np.linalg.norm(points - centre, axis=1).mean())
    kept = np.ones(len(points), dtype=bool)
    off = np.zeros(len(points))
    for _ in range(_ROUNDS):
        apart = points - centre
        far = np.linalg.norm(apart, axis=1)
        off = far - radius
        spread = 1.4826 * float(np.median(np.abs(off)))
        before, kept = kept, np.abs(off) <= max(_FAR * spread, 1e-9 * radius)  # half of them at least
        normals = apart[kept] / far[kept, None]
        step = _least_squares(np.column_stack([normals, np.ones(len(normals))]), off[kept])
        centre, radius = centre + step[:2], radius + float(step[2])
        if np.abs(step).max() < _SETTLED * radius and np.array_equal(before, kept):
            break
    apart = points[kept] - centre
    angle = np.arctan2(apart[:, 1], apart[:, 0])
    waves = np.column_stack([np.ones(len(angle)), np.cos(2 * angle), np.sin(2 * angle)])
    _, cosine, sine = _least_squares(waves, np.linalg.norm(apart, axis=1))
    oblique = 2 * float(np.hypot(cosine, sine)) / radius
    return Circle(float(centre[0]), float(centre[1]), radius, float(off[kept].std()), oblique)


def _least_squares(terms: FloatArray, values: FloatArray) -> FloatArray:
    """Return the coefficients of terms that are as good as orthogonal, points lying all around."""
    return np.asarray(np.linalg.solve(terms.T @ terms, np.einsum("ki,k->i", terms, values)))
