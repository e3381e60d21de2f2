r"""How far noise lifts the background of a magnitude picture.

::

    signal A, noise σ in either channel: grey M = |A + noise|         count
                                                                        /\
      no signal: Rayleigh, mean √(π/2)·σ = 1.25 σ                      /  `-._      skewness 0.63
      A ≫ σ:     nearly Gaussian about A                             0 |  1.25σ

The level half-way between background and body is half-way between *no signal* and the body: an edge pixel,
half of it body, lies far above the noise and is not lifted. CT's noise is symmetric and lifts nothing.

Source: Gudbjartsson & Patz (1995), Magnetic Resonance in Medicine 34:910.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

MEAN = float(np.sqrt(0.5 * np.pi))
"""Of Rayleigh's distribution, in σ."""
MEDIAN = float(np.sqrt(2.0 * np.log(2.0)))
"""Its median, in σ."""
SPREAD = float(np.sqrt(2.0 - 0.5 * np.pi))
"""Its standard deviation, in σ."""
EMPTY = 2.5
"""In floors above no signal: what is darker is taken for empty (3.1 σ; one empty pixel in 130 is not)."""
FEWEST = 300
"""Values below which a distribution's skewness is not known: its standard error is √(6/n)."""
_SKEWED = (
    0.3,
    0.5,
    0.8,
    1.0,
)  # skewness: from the first no longer symmetric, to the last no longer Rayleigh's
_OUTLIER = 6.0  # robust standard deviations


def without_floor(values: NDArray[Any], background: float, floor: float) -> NDArray[np.float32]:
    """Return grey levels with what noise adds to empty pixels taken off these.

    Parameters
    ----------
    values : array
        Grey levels, signal towards higher ones.
    background : float
        Grey level of no signal.
    floor : float
        From `noise_floor`.

    Examples
    --------
    >>> without_floor(np.array([10.0, 12.0, 60.0]), 0.0, 10.0).tolist()
    [0.0, 2.0, 60.0]
    """
    grey = values.astype(np.float32)
    grey[grey < np.float32(background + EMPTY * floor)] -= np.float32(floor)
    return grey


def noise_floor(values: NDArray[Any]) -> float:
    """Return by how much noise lifts the mean of background pixels above no signal; 0 where it does not.

    Parameters
    ----------
    values : (n,) array
        Grey levels of background alone, signal towards higher ones.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> real, imaginary = rng.normal(0.0, 8.0, (2, 20000))
    >>> abs(noise_floor(np.hypot(real, imaginary)) - 8 * MEAN) < 0.3, noise_floor(real)
    (True, 0.0)
    """
    if len(values) < FEWEST:
        return 0.0
    middle = float(np.median(values))
    robust = 1.4826 * float(np.median(np.abs(values - middle)))
    usual = values[np.abs(values - middle) <= _OUTLIER * robust].astype(np.float64)
    spread = float(usual.std()) if len(usual) else 0.0
    if not spread > 0.0:
        return 0.0
    skewness = float((((usual - usual.mean()) / spread) ** 3).mean())
    trust = float(np.interp(skewness, _SKEWED, (0.0, 1.0, 1.0, 0.0)))
    return trust * MEAN / SPREAD * spread
