r"""A smooth course told from the jitter about it, both of unknown strength.

::

      *       *            The course has small third differences, the jitter is independent from point to
    ~~~~~~*~~~~~~~~ *      point. How rough the course is and how strong the jitter are those under which
     *          *          the third differences seen are likeliest (restricted maximum likelihood, for
                           parabolas are left out of it).

Whittaker (1923), "On a new method of graduation", Proc. Edinburgh Math. Soc. 41, 63–75; Patterson &
Thompson (1971), "Recovery of inter-block information when block sizes are unequal", Biometrika 58, 545–554.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.roughness import third_differences

FloatArray = NDArray[np.float64]

_RATIOS = np.logspace(-6, 6, 121)
"""Variance of the course's third differences by that of the jitter."""


def jitter_about_trend(position: FloatArray, values: FloatArray) -> FloatArray:
    """Return what of each value is jitter, (m, n): what is left when it is taken away is the smooth course.

    Parameters
    ----------
    position : array (m), increasing, m ≥ 5
    values : array (m, n)
        All n with jitter and roughness of one strength.

    Examples
    --------
    >>> z = np.arange(12.0)
    >>> bow = np.column_stack([0.3 * (z - 6) ** 2, 2 * z])
    >>> bool(np.abs(jitter_about_trend(z, bow)).max() < 1e-9)
    True
    >>> noise = np.random.default_rng(1).normal(size=bow.shape)
    >>> left = bow + noise - jitter_about_trend(z, bow + noise) - bow
    >>> bool(left.std() < 0.5 * noise.std())
    True
    """
    weights = third_differences(position, np.eye(len(position)))
    given = weights @ values
    power, modes = np.linalg.eigh(weights @ weights.T)
    seen = modes.T @ given
    if not seen.any():
        return np.zeros_like(values)
    variances = _RATIOS[:, None] + power
    scale = np.einsum("rk,k->r", 1 / variances, (seen**2).sum(axis=1)) / seen.size
    cost = seen.size * np.log(scale) + values.shape[1] * np.log(variances).sum(axis=1)
    ratio = _RATIOS[int(np.argmin(cost))]
    jitter: FloatArray = weights.T @ (modes @ (seen / (ratio + power)[:, None]))
    return jitter
