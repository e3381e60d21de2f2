"""Points and slopes on closed piecewise cubics, sample by sample."""

from __future__ import annotations

from ctypes import c_int, c_int64, c_void_p
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from stackloft.compiled.arrays import address
from stackloft.compiled.kernel import Kernel

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_sample = Kernel(
    "stackloft_on_curves", c_int, *(c_int64 * 3, c_void_p, c_void_p, c_void_p, c_void_p * 6, c_void_p)
)


class Curves(Protocol):
    """The stack of curves: a `CurveStack`."""

    @property
    def first(self) -> IntArray:
        """(m + 1,) first segment of each section."""

    @property
    def knots(self) -> FloatArray:
        """(n + 1,) of the segments."""

    @property
    def starts(self) -> FloatArray:
        """(m,) canonical starts."""

    @property
    def points(self) -> FloatArray:
        """(2, n) segment starts."""

    @property
    def ends(self) -> FloatArray:
        """(2, n) segment ends."""

    @property
    def leaving(self) -> FloatArray:
        """(2, n) slopes at the starts."""

    @property
    def arriving(self) -> FloatArray:
        """(2, n) slopes at the ends."""


def on_curves(curves: Curves, section: NDArray[Any], s: NDArray[Any]) -> FloatArray | None:
    """Return points and derivatives, (2, 2, ...): x and y of either; None without compiled kernels.

    Parameters
    ----------
    curves : CurveStack
    section : int array, broadcastable with `s`
    s : array
        Fractions of arc length from each canonical start.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> side = np.array([[1.0], [0.0]])
    >>> there_and_back = SimpleNamespace(
    ...     first=np.array([0, 2]), knots=np.array([0.0, 0.5, 1.0]), starts=np.zeros(1),
    ...     points=side * [0, 1], ends=side * [1, 0], leaving=side * [1, -1], arriving=side * [1, -1],
    ... )
    >>> found = on_curves(there_and_back, np.array([0]), np.array([0.25, 0.75]))
    >>> found is None or found[:, 0].tolist()
    [[0.5, 0.5], [2.0, -2.0]]
    """
    sample = _sample.here()
    if sample is None:
        return None
    shape = np.broadcast_shapes(section.shape, s.shape)
    own = np.ascontiguousarray(np.broadcast_to(section, shape), np.int64)
    fractions = np.ascontiguousarray(np.broadcast_to(s, shape), np.float64)
    first = np.ascontiguousarray(curves.first, np.int64)
    figures = (curves.knots, curves.starts, curves.points, curves.ends, curves.leaving, curves.arriving)
    stack = [np.ascontiguousarray(each, np.float64) for each in figures]
    planes = np.empty((2, 2, *shape))
    counts = (c_int64 * 3)(own.size, len(first) - 1, len(stack[0]) - 1)
    places = (c_void_p * 6)(*map(address, stack))
    known = sample(counts, address(own), address(fractions), address(first), places, address(planes))
    return planes if known else None
