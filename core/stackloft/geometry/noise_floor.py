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

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.median import median

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


@dataclass(frozen=True, slots=True)
class NoiseFloor:
    """What noise adds to the empty pixels of a magnitude picture."""

    empty: float
    """Grey level below which a pixel is taken for empty."""
    lift: float
    """Grey levels that noise adds to such a pixel's mean."""

    @staticmethod
    def over(background: float, lift: float) -> NoiseFloor | None:
        """Return the floor of `lift` grey levels (from `noise_floor`) over no signal; None of 0."""
        return NoiseFloor(background + EMPTY * lift, lift) if lift > 0.0 else None

    def taken_off(self, values: NDArray[Any]) -> NDArray[np.float64]:
        """Return grey levels without what noise adds to empty pixels, signal being towards higher ones.

        Examples
        --------
        >>> NoiseFloor.over(0.0, 10.0).taken_off(np.array([10.0, 12.0, 60.0])).tolist()
        [0.0, 2.0, 60.0]
        """
        grey = values.astype(np.float64)
        grey -= self.lift * (grey < self.empty)  # a fifth of the time that picking them out takes
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
    middle = median(values)
    away = np.abs(values.astype(np.float32) - np.float32(middle))
    usual = values[away <= _OUTLIER * 1.4826 * median(away)].astype(np.float64)
    usual -= usual.mean()
    square = usual * usual
    spread = float(np.sqrt(square.mean()))
    if not spread > 0.0:
        return 0.0
    skewness = float((square @ usual) / (len(usual) * spread**3))
    trust = float(np.interp(skewness, _SKEWED, (0.0, 1.0, 1.0, 0.0)))
    return trust * MEAN / SPREAD * spread
