"""The Gauss-Newton system of points that slide along their sections' curves."""

from __future__ import annotations

from ctypes import c_double, c_int64, c_void_p

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import address
from stackloft.compiled.kernel import Kernel

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

_system = Kernel(
    "stackloft_slide_system",
    None,
    *(c_int64, c_int64, c_void_p * 9, c_double * 2, c_void_p, c_double, c_void_p * 4),
)


def slide_system(
    on_curves: tuple[FloatArray, FloatArray],
    fractions: tuple[FloatArray, FloatArray, FloatArray],
    weights: tuple[FloatArray, FloatArray],
    costs: tuple[float, float],
    held: tuple[BoolArray, float],
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray] | None:
    """Return what `solve_rings` takes, (m, n) each; None without compiled kernels.

    Parameters
    ----------
    on_curves : tuple of (m, n, 2) arrays
        Points from their section's centroid, and slopes.
    fractions : tuple of (m, n) arrays
        Current, first guess, and spacing from each point to the next.
    weights : tuple of (m - 1,) and (m,) arrays
        Of each pair of sections, and of each section.
    costs : tuple of float
        Of unevenness, and of leaving the first guess.
    held : tuple of (m, n) bool array and float
        Points that stay, by coefficients so many times the largest.
    """
    system = _system.here()
    if system is None:
        return None
    planes = [np.ascontiguousarray(each[..., k], np.float64) for each in on_curves for k in (0, 1)]
    rows = [np.ascontiguousarray(each, np.float64) for each in (*fractions, *weights)]
    fixed, huge = np.ascontiguousarray(held[0], bool), held[1]
    found = np.empty((4, *fixed.shape))
    places = (c_void_p * 9)(*map(address, (*planes, *rows)))
    rooms = (c_void_p * 4)(*map(address, found))
    system(*fixed.shape, places, (c_double * 2)(*costs), address(fixed), huge, rooms)
    diagonal, along, across, right = found
    return diagonal, along, across, right
