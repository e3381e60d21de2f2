r"""How far a sequence of values is from a smooth function of position.

::

        *                      Through any three neighbours goes one parabola; the roughness of the sequence
      *   *  <- third          is how far the fourth lies off it, taken over all four neighbours alike:
    *       *                  their third divided difference, scaled to a weight of √20 in the values.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

NOISE = float(np.sqrt(20.0))
"""Independent noise of standard deviation s in the values makes third differences of NOISE · s."""
FEWEST = 6
"""Values below which nothing is said."""


def third_differences(position: FloatArray, values: FloatArray) -> FloatArray:
    """Return the third differences of each four neighbours, (m - 3, n).

    Parameters
    ----------
    position : array (m), increasing
    values : array (m, n)

    Returns
    -------
    array (m - 3, n)
        In the values' unit; whatever the positions' distances, weighted so that the sum of the squared
        weights is 20, as it is for equal distances (1, -3, 3, -1).

    Examples
    --------
    >>> z = np.array([0.0, 1, 2, 4, 5])
    >>> np.abs(third_differences(z, (3 * z**2 - z)[:, None])).max() < 1e-12
    np.True_
    >>> third_differences(np.arange(4.0), np.array([[0.0], [1], [0], [0]])).tolist()
    [[3.0]]
    """
    windows = np.stack([position[k : len(position) - 3 + k] for k in range(4)], axis=1)
    apart = windows[:, :, None] - windows[:, None, :] + np.eye(4)
    weights = 1.0 / apart.prod(axis=2)
    weights *= NOISE / np.linalg.norm(weights, axis=1, keepdims=True)
    stacked = np.stack([values[k : len(values) - 3 + k] for k in range(4)], axis=1)
    differences: FloatArray = np.einsum("wk,wkn->wn", weights, stacked)
    return differences


def roughness(position: FloatArray, values: FloatArray) -> float:
    """Return the mean square of the values' third differences by 20: the variance of noise that makes them.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> bool(abs(roughness(np.arange(2000.0), rng.normal(size=(2000, 1))) - 1) < 0.1)
    True
    """
    return float((third_differences(position, values) ** 2).sum(axis=1).mean()) / NOISE**2
