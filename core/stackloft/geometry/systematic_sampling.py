r"""Precision of a sum over equally spaced sections whose phase is random (Cavalieri sampling).

::

    A(z)   |    .--.          sections at z0 + k·T, z0 uniform in [0, T):
           |  /|  | \         V = T·ΣA_k is unbiased; its variance follows from how smooth A is,
           +-|--|--|--|-- z   which the areas themselves show
             <T>

Covariogram of the areas: C_j = Σ A_k·A_(k+j). The transitive theory of Matheron (1965) gives

    Var V = α(q)·T²·(3 C_0 − 4 C_1 + C_2)

with α = 1/12 where A jumps (q = 0; Gundersen & Jensen 1987, J. Microsc. 147:229) and 1/240 where only its
slope does (q = 1; Gundersen, Jensen, Kiêu & Nielsen 1999, J. Microsc. 193:199). The class q between is
estimated from the areas (Kiêu, Souchet & Istas 1999, J. Stat. Plan. Inference 77:263), with α(q) of
García-Fiñana & Cruz-Orive (2004), Statistics 38:243.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import zeta

FloatArray = NDArray[np.float64]

FEWEST = 5
"""Sections below which the smoothness class cannot be estimated."""


@dataclass(frozen=True, slots=True)
class SamplingPrecision:
    """What systematic sampling costs."""

    smoothness: float
    """q in [0, 1]: 0 where the areas jump, 1 where their slope does."""
    coefficient_of_error: float
    """Standard deviation of the sum over its value, by the estimated class."""


def sampling_precision(areas: FloatArray) -> SamplingPrecision | None:
    """Return the precision of Σ areas, or None when there are too few sections.

    Parameters
    ----------
    areas : (m,) array
        Section areas at equal distances, any unit.

    Examples
    --------
    A ball, seven sections at a random phase; the parabola's slope jumps at both poles:

    >>> z = (np.arange(7) + 0.3) / 7
    >>> found = sampling_precision(z * (1 - z))
    >>> round(found.smoothness, 2), bool(0.004 < found.coefficient_of_error < 0.02)
    (1.0, True)
    """
    if len(areas) < FEWEST:
        return None
    padded = np.concatenate([areas, np.zeros(4)])
    c = [float(padded[: len(areas)] @ padded[j : j + len(areas)]) for j in range(5)]
    near, far = 3 * c[0] - 4 * c[1] + c[2], 3 * c[0] - 4 * c[2] + c[4]
    if near <= 0.0:
        return SamplingPrecision(1.0, 0.0)
    q = 0.5 * math.log2(far / near) - 0.5 if far > near else 0.0
    q = min(max(q, 0.0), 1.0)
    return SamplingPrecision(q, math.sqrt(alpha(q) * near) / float(areas.sum()))


def alpha(q: float) -> float:
    """Return García-Fiñana & Cruz-Orive's α(q), 0 ≤ q ≤ 1.

    Examples
    --------
    >>> [round(1 / alpha(q), 9) for q in (0.0, 1.0)]
    [12.0, 240.0]
    >>> abs(alpha(0.5) / alpha(0.5 + 1e-6) - 1) < 1e-4
    True
    """
    if abs(q - 0.5) < 1e-9:
        return float(zeta(3)) / (8.0 * math.pi**2 * math.log(2.0))
    scale = math.gamma(2 * q + 2) * float(zeta(2 * q + 2)) * math.cos(math.pi * q)
    return float(scale / ((2.0 * math.pi) ** (2 * q + 2) * (1.0 - 2.0 ** (2 * q - 1))))
