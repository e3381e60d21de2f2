"""A line through the origin by least squares: y = a·x.

a = Σxy/Σx²; with n − 1 degrees of freedom s² = SSR/(n − 1) and the standard error of a is s/√Σx²
(Eisenhauer 2003, Teaching Statistics 25:76).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from stackloft.model.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class OriginFit:
    """The line and how well it fits."""

    coefficient: float
    standard_error: float
    interval95: tuple[float, float]
    """By Student's t with n − 1 degrees of freedom."""
    r_squared: float | None
    """1 − SSR/SST, SST about the mean of y, as Goñi, Purlis & Salvadori (2007) have it: it may be negative.
    None when all y are equal."""
    r_squared_uncentred: float
    """1 − SSR/Σy², as most programs give for a line without an intercept: always higher."""
    residual: float
    """Residual standard deviation s, in y's unit."""


def fit_through_origin(x: FloatArray, y: FloatArray) -> OriginFit:
    """Return the least-squares line y = a·x.

    Parameters
    ----------
    x, y : array (n,)
        n ≥ 2; x not all zero.

    Examples
    --------
    >>> import numpy as np
    >>> fit = fit_through_origin(np.array([1.0, 2.0, 3.0]), np.array([2.0, 4.0, 6.0]))
    >>> fit.coefficient, fit.standard_error, fit.r_squared
    (2.0, 0.0, 1.0)
    """
    from scipy.special import stdtrit  # noqa: PLC0415 - heavy, and needed here alone

    a = float(x @ y) / float(x @ x)
    ssr = float(((y - a * x) ** 2).sum())
    sst = float(((y - y.mean()) ** 2).sum())
    residual = math.sqrt(ssr / (len(x) - 1))
    error = residual / math.sqrt(float(x @ x))
    reach = float(stdtrit(len(x) - 1, 0.975)) * error
    flat = sst <= 1e-24 * float(y @ y)
    return OriginFit(
        a,
        error,
        (a - reach, a + reach),
        None if flat else 1.0 - ssr / sst,
        1.0 - ssr / float(y @ y),
        residual,
    )
