"""Derivatives by the complex step, so that no body needs hand-written ones.

For a real-analytic f, Im f(x + ih)/h is f'(x) without cancellation; with h = 1e-30 it is exact to
rounding (Squire & Trapp 1998, SIAM Review 40, 110–112). A body's formulas therefore take real or
complex arrays; where a formula is not analytic (|t|^p) the rule here carries the derivative along.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
"""Real, or complex while a derivative is taken."""

STEP = 1e-30


def power_abs(t: Array, p: float) -> Array:
    """Return |t|^p, p ≥ 1, with its derivative p·|t|^(p−1)·sgn t carried in the imaginary part.

    Examples
    --------
    >>> t = np.array([-2.0 + 1j * STEP])
    >>> value = power_abs(t, 3)
    >>> float(value.real[0]), round(float(value.imag[0] / STEP), 12)
    (8.0, -12.0)
    """
    size = np.abs(t.real)
    value: Array = size**p
    if np.iscomplexobj(t):
        value = value + 1j * (p * size ** (p - 1) * np.sign(t.real) * t.imag)
    return value


def power_signed(t: Array, p: float) -> Array:
    """Return sgn(t)·|t|^p, p ≥ 1: monotone, so that a maximum of such pieces is a convex body.

    Examples
    --------
    >>> power_signed(np.array([-2.0, 3.0]), 2).tolist()
    [-4.0, 9.0]
    """
    value: Array = power_abs(t, p) * np.sign(t.real)
    return value


def arctan2(y: Array, x: Array) -> Array:
    """Return the angle of (x, y) in (−π, π], with its derivative carried.

    Examples
    --------
    >>> arctan2(np.array([1.0]), np.array([0.0])).round(12).tolist()
    [1.570796326795]
    """
    angle: Array = np.arctan2(y.real, x.real)
    if np.iscomplexobj(y) or np.iscomplexobj(x):
        angle = angle + 1j * (x.real * y.imag - y.real * x.imag) / (x.real**2 + y.real**2)
    return angle


def derivative(f: Callable[[Array], Array], t: Array) -> Array:
    """Return df/dt elementwise for an `f` that maps each entry of `t` by itself.

    Examples
    --------
    >>> derivative(np.sin, np.array([0.0])).tolist()
    [1.0]
    """
    slope: Array = f(t + 1j * STEP).imag / STEP
    return slope
