r"""Where between two pixels the boundary lies, exactly so for straight edges.

::

     field  a     b        c     d
            o-----o---*----o-----o      the edge crosses between b and c
            |-----window---|            its mean over three pixels, S0 = (a + b + c) / 3,
                  |-----window---|      and S1 = (b + c + d) / 3, one pixel on

A pixel holds the mean grey level over its own square, so the sum of the levels along a line across an
edge is the length of the line that lies in the body (the partial-area effect: Trujillo-Pino, Krissian,
Alemán-Flores & Santana-Cedrés 2013, doi:10.1016/j.imavis.2012.10.005). Interpolating the three-pixel
means linearly reads that length off: for every straight edge no steeper than 45° to the line the
result is exact, whereas linear interpolation of the pixels themselves errs by up to 0.09 px. Blurred by
0.7 pixels or more, a step is wide enough for the cubic through four pixels.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft.sectioning.marching_squares import Crossings

REACH = 2
"""Pixels beyond the crossed edge that are looked at: the field must have that much of a border."""

_BEYOND = 0.25  # how far past the two pixels the refined crossing may lie
_DOMINANCE = 0.8
_NEARLY_OFF, _OFF = 0.15, 0.25  # distance of the level from the middle of the step, as a part of the step
_BLURRED, _SHARP = 0.46, 0.54  # part of the step that lies between the two pixels: 0.6 to 0.8 without blur,
# 0.44 to 0.53 with a Gaussian blur of 0.7 pixels
_NEWTON_STEPS = 4
_FEWEST = 16  # crossings below which a line is too small to be refined


def crossing_points(line: Crossings, field: NDArray[Any], level: float = 0.0) -> FloatArray:
    """Return the points of a closed line at which `field` equals `level`.

    Only crossings of edges that run across the boundary rather than along it are kept, about one for
    each pixel of its length, because the others are ill-conditioned.

    Parameters
    ----------
    line : Crossings
        From `closed_lines`.
    field : ndarray, (rows, columns)
        Of any real dtype; the line keeps `REACH` pixels from its border.
    level : float
        What the field is on the boundary.

    Returns
    -------
    ndarray, (k, 2)
        (column, row), sub-pixel.

    Examples
    --------
    >>> from stackloft.sectioning.marching_squares import closed_lines
    >>> field = np.full((30, 30), -1.0)
    >>> field[8:20, 8:20] = 1.0
    >>> field[8:20, 20] = -0.4                      # covered by 0.3: the edge lies at 19.8
    >>> points = crossing_points(closed_lines(field > 0, field)[0], field)
    >>> round(float(points[:, 0].max()), 12)
    19.8
    """
    along = np.where(line.down, field.shape[1], 1)
    across = np.where(line.down, 1, field.shape[1])
    base = line.row * field.shape[1] + line.column
    flat = field.ravel()
    samples = [flat[base + step * along] - level for step in (-1, 0, 1, 2)]
    fraction = samples[1] / (samples[1] - samples[2])
    if len(base) >= _FEWEST:
        keep = _runs_across(flat, base, along, across)
        fraction = np.where(keep, _refined(samples, fraction), fraction)
        if keep.sum() >= _FEWEST // 2:
            line = Crossings(line.row[keep], line.column[keep], line.down[keep])
            fraction = fraction[keep]
    x = line.column + np.where(line.down, 0.0, fraction)
    y = line.row + np.where(line.down, fraction, 0.0)
    return np.column_stack([x, y])


def _refined(samples: list[FloatArray], plain: FloatArray) -> FloatArray:
    """Return the crossings of the three-pixel means, or of the cubic where that serves better.

    Averaging makes a step three pixels wide. That is needed where the picture is so sharp that the step
    takes less than two; where the lens has blurred it, or the level is far from its middle, the cubic
    is as good and sees less of a skin that is darker than the flesh behind it.
    """
    a, b, c, d = samples
    clean = (a * b > 0) & (c * d > 0)
    if not clean.any():
        return plain
    cubic = np.where(clean, _cubic_crossing(samples, plain), plain)
    means = np.divide(a + b + c, a - d, out=cubic.copy(), where=clean)
    off_middle = np.divide(np.abs(a + d) / 2, np.abs(a - d), out=np.ones_like(a), where=clean)
    sharpness = np.abs(b - c)[clean].sum() / np.abs(a - d)[clean].sum()
    share = _ramp(sharpness, _BLURRED, _SHARP) * _ramp(-off_middle, -_OFF, -_NEARLY_OFF)
    near = (means >= -_BEYOND) & (means <= 1 + _BEYOND)
    return np.where(near, share * means + (1 - share) * cubic, cubic)


def _cubic_crossing(samples: list[FloatArray], start: FloatArray) -> FloatArray:
    """Return where the cubic through the four samples is zero, between the middle two (Newton's method)."""
    a, b, c, d = samples
    linear = -a / 3 - b / 2 + c - d / 6
    square = a / 2 - b + c / 2
    cube = (b - c) / 2 + (d - a) / 6
    t = start
    for _ in range(_NEWTON_STEPS):
        slope = linear + t * (2 * square + 3 * t * cube)
        value = b + t * (linear + t * (square + t * cube))
        t = np.clip(t - np.divide(value, slope, out=np.zeros_like(t), where=slope != 0), 0.0, 1.0)
    return t


def _ramp(value: FloatArray, low: float, high: float) -> FloatArray:
    """Return 0 below `low`, 1 above `high`, and the straight line between."""
    return np.clip((value - low) / (high - low), 0.0, 1.0)


def _runs_across(
    flat: NDArray[Any], base: NDArray[np.int64], along: NDArray[np.int64], across: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Return whether the field changes faster along the crossed edge than across it.

    Slopes of the plane fitted to the 4 × 3 pixels around the edge by least squares.
    """
    steep = np.zeros(len(base))
    flank = np.zeros(len(base))
    for step, lever in zip((-1, 0, 1, 2), (-1.5, -0.5, 0.5, 1.5), strict=True):
        rows = [flat[base + step * along + side * across].astype(np.float64) for side in (-1, 0, 1)]
        steep += lever * (rows[0] + rows[1] + rows[2]) / 15.0
        flank += (rows[2] - rows[0]) / 8.0
    return np.asarray(np.abs(steep) >= _DOMINANCE * np.abs(flank))
