r"""Cubic interpolation across rows that keeps clear of steps.

::

    f(i−2) f(i−1) f(i) f(i+1) f(i+2)      three parabolas give a slope at row i each; on equal spacing
      \______________/                    1/6, 2/3, 1/6 of them is the slope of fourth order; a parabola
             \______________/             that bends much more than the others crosses a step and counts
                  \______________/        for little (Jiang & Shu 1996, JCP 126:202: WENO)

All three are exact for parabolas on any spacing, and so is what is made of them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_SHARES = (1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0)


class HermiteRows:
    """Cubic Hermite interpolation of rows with slopes that do not look across steps."""

    def __init__(self, nodes: FloatArray, values: NDArray[Any], level: float = 1e-6) -> None:
        """Prepare the slopes.

        Parameters
        ----------
        nodes : (k,) array
            Increasing, k ≥ 2.
        values : (k, ...) array
        level : float
            Second divided differences below this count alike.

        Examples
        --------
        >>> t = np.array([0.0, 1.0, 2.5, 3.0, 5.0])
        >>> curve = HermiteRows(t, t**2 - 3 * t)
        >>> float(curve(4.0))
        4.0
        >>> step = HermiteRows(np.arange(8.0), np.repeat([0.0, 9.0], 4))
        >>> bool(abs(step(1.5)) < 1e-6 and abs(step(5.5) - 9) < 1e-6)
        True
        """
        self.nodes = nodes
        self.values = values
        self.slopes = _slopes(nodes, values, level)

    def __call__(self, t: float) -> NDArray[Any]:
        """Return the row at `t`, (...)."""
        i = int(np.clip(np.searchsorted(self.nodes, t, side="right") - 1, 0, len(self.nodes) - 2))
        gap = self.nodes[i + 1] - self.nodes[i]
        s = (t - self.nodes[i]) / gap
        a, b = self.values[i], self.values[i + 1]
        u, v = self.slopes[i] * gap, self.slopes[i + 1] * gap
        found: NDArray[Any] = a + s * (u + s * (3.0 * (b - a) - 2.0 * u - v + s * (2.0 * (a - b) + u + v)))
        return found


def _slopes(nodes: FloatArray, values: NDArray[Any], level: float) -> NDArray[Any]:
    shape = (-1,) + (1,) * (values.ndim - 1)
    gaps = np.diff(nodes)
    steps = np.diff(values, axis=0) / gaps.reshape(shape)
    if len(nodes) == 2:
        return np.repeat(steps, 2, axis=0)
    bends = np.diff(steps, axis=0) / (nodes[2:] - nodes[:-2]).reshape(shape)  # second divided differences
    k, last = len(nodes), len(bends) - 1
    slopes = np.zeros_like(values)
    for i in range(k):
        total = 0.0
        for share, j in zip(_SHARES, (i - 2, i - 1, i), strict=True):  # the parabola through rows j, j+1, j+2
            if not 0 <= j <= last:
                continue
            weight = share / (level**2 + bends[j] ** 2) ** 2
            own = steps[j] + bends[j] * (2.0 * nodes[i] - nodes[j] - nodes[j + 1])
            slopes[i] += weight * own
            total = total + weight
        slopes[i] /= total
    return slopes
