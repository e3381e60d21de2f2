"""Uneven light taken out: the plate's brightness, a smooth surface, divided away.

A plate of one colour is as bright as the light that falls on it. Its grey levels beside the body, fitted by a
quadratic surface, tell the light everywhere; divided by it, one grey level is the same shade all over the
picture (flat-field correction from the background itself). A dark plate tells nothing of the light and
needs nothing: the body's edge stands far above it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray, IntArray
from stackloft_plugins.segmenters.body_window import Mask
from stackloft_plugins.segmenters.grey import Grey

Window = tuple[slice, slice]
"""Rows and columns."""

_KEEP_OFF = 4
"""Coarse pixels around the body that are not taken for plate."""
_MOST = 6000
"""Pixels of plate, evenly chosen, that the surface is fitted to; it has six coefficients."""
_ROUNDS = 4
_OUTLIER = 2.5
"""Standard deviations; shadows, juice and reference objects lie further off."""
_LEAST = 0.15
"""Share of the picture that must be plate for a fit."""
AT_ONCE = 64
"""Rows divided at once, few enough to stay in the processor's cache."""
_STRONGEST = 0.6
"""The light may not fall below this fraction of its mean; a fit that says so is no light."""


@dataclass(frozen=True, slots=True, eq=False)
class Light:
    """Relative brightness over a picture, mean 1 over the plate."""

    coefficients: FloatArray
    """(6,) of 1, x, y, x², xy, y² with x and y from −1 to 1 over the picture."""
    shape: tuple[int, int]
    """(rows, columns) of the whole picture."""

    def flattened(self, grey: NDArray[Any], window: Window) -> Grey:
        """Return the grey levels of a window of the picture, as under even light."""
        flat = np.empty(grey.shape, np.float32)
        for some, light in self.strips(window):
            cv2.divide(np.ascontiguousarray(grey[some]), light, flat[some], dtype=cv2.CV_32F)
        return flat

    def strips(self, window: Window) -> Iterator[tuple[slice, Grey]]:
        """Yield the brightness in a window, `AT_ONCE` of its rows at once and the last ones perhaps fewer."""
        rows, columns = (np.arange(side)[kept] for side, kept in zip(self.shape, window, strict=True))
        factors = tuple(factor.astype(np.float32) for factor in self._factors(rows, columns))
        for top in range(0, len(rows), AT_ONCE):
            some = slice(top, min(top + AT_ONCE, len(rows)))
            yield some, np.asarray(_product(factors[0][:, some], factors[1]), np.float32)

    def at(
        self,
        rows: FloatArray | IntArray,
        columns: FloatArray | IntArray,
        dtype: type[np.floating[Any]] = np.float64,
    ) -> NDArray[np.floating[Any]]:
        """Return the brightness at rows × columns."""
        down, along = self._factors(rows, columns)
        return _product(down.astype(dtype), along.astype(dtype))

    def _factors(
        self, rows: FloatArray | IntArray, columns: FloatArray | IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return what `_product` makes the brightness of: (2, rows) and (2, columns)."""
        y = 2.0 * rows / max(self.shape[0] - 1, 1) - 1.0
        x = 2.0 * columns / max(self.shape[1] - 1, 1) - 1.0
        c = self.coefficients
        return np.stack([c[0] + c[2] * y + c[5] * y * y, c[1] + c[4] * y]), np.stack([x, c[3] * x * x])


def _product(down: NDArray[np.floating[Any]], along: NDArray[np.floating[Any]]) -> NDArray[np.floating[Any]]:
    """Return down[0] + down[1] · along[0] + along[1]; BLAS would wake threads of its own."""
    light = np.multiply(down[1][:, None], along[0])
    light += down[0][:, None]
    light += along[1]
    return np.asarray(light)


def fit_light(coarse: Grey, body: Mask, step: int, shape: tuple[int, int]) -> Light | None:
    """Return the light over a bright plate.

    Parameters
    ----------
    coarse : ndarray, (rows / step, columns / step)
        Grey levels of every `step`-th pixel.
    body : ndarray of uint8, same shape
        1 where the coarse look sees anything but plate.
    step : int
    shape : (rows, columns) of the whole picture.

    Returns
    -------
    Light or None
        None when too little plate is seen, or when what is seen is no light.

    Examples
    --------
    >>> y, x = np.mgrid[-1:1:60j, -1:1:80j]
    >>> plate = (200 * (1 + 0.05 * x - 0.03 * y * y)).astype(np.float32)
    >>> light = fit_light(plate, np.zeros(plate.shape, np.uint8), 1, plate.shape)
    >>> bool(np.ptp(light.flattened(plate, np.s_[:, :])) < 0.01)
    True
    """
    kernel = np.ones((2 * _KEEP_OFF + 1, 2 * _KEEP_OFF + 1), np.uint8)
    plate = cv2.dilate(body, kernel) == 0
    if plate.mean() < _LEAST:
        return None
    where = np.flatnonzero(plate)
    row, column = np.divmod(where[:: max(1, len(where) // _MOST)], plate.shape[1])
    value = coarse[row, column].astype(np.float64)
    y = 2.0 * row * step / max(shape[0] - 1, 1) - 1.0
    x = 2.0 * column * step / max(shape[1] - 1, 1) - 1.0
    terms = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    found = _robust_fit(terms, value)
    if found is None:
        return None
    light = Light(found / np.einsum("ij,j->i", terms, found).mean(), shape)
    corners = light.at(np.linspace(0, shape[0] - 1, 9), np.linspace(0, shape[1] - 1, 9))
    return light if corners.min() > _STRONGEST and corners.max() < 1.0 / _STRONGEST else None


def _robust_fit(terms: FloatArray, value: FloatArray) -> FloatArray | None:
    """Return the least-squares surface without what lies far off it; None when little is left."""
    kept = np.ones(len(value), dtype=bool)
    coefficients: FloatArray = np.zeros(terms.shape[1])
    for _ in range(_ROUNDS):
        used = terms[kept]  # normal equations: six terms within -1 to 1 are well conditioned
        try:
            sums = np.einsum("ij,i->j", used, value[kept])  # BLAS wakes threads of its own for either product
            coefficients = np.asarray(np.linalg.solve(used.T @ used, sums), np.float64)
        except np.linalg.LinAlgError:
            return None
        off = np.abs(value - np.einsum("ij,j->i", terms, coefficients))
        kept = off <= max(_OUTLIER * 1.4826 * float(np.median(off)), 1.0)
        if kept.mean() < 0.5:
            return None
    return coefficients
