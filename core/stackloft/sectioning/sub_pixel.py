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

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.flat_view import flat_view
from stackloft.geometry.noise_floor import NoiseFloor
from stackloft.model.arrays import FloatArray, IntArray
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


@dataclass(frozen=True, slots=True, eq=False)
class LevelLine:
    """A closed line to be put where `field` equals `level`."""

    crossings: Crossings
    """It keeps `REACH` pixels from the field's border."""
    field: NDArray[Any]
    """(rows, columns), of any real dtype"""
    level: float
    noise: NoiseFloor | None = None
    """What noise still adds to empty pixels of the field."""


def crossing_points(line: Crossings, field: NDArray[Any], level: float = 0.0) -> FloatArray:
    """Return the points of one closed line, (k, 2), as `points_of_lines` does.

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
    return points_of_lines([LevelLine(line, field, level)])[0]


def points_of_lines(lines: Sequence[LevelLine]) -> list[FloatArray]:
    """Return the points of closed lines at which each one's field equals its level.

    Only crossings of edges that run across the boundary rather than along it are kept, about one for
    each pixel of its length, because the others are ill-conditioned. Many lines at once, of many slices, take
    less time than one by one.

    Parameters
    ----------
    lines : sequence of LevelLine

    Returns
    -------
    list of (k, 2) arrays
        (column, row), sub-pixel.
    """
    if not lines:
        return []
    counts = np.array([len(line.crossings.row) for line in lines])
    starts = np.cumsum(counts) - counts
    row, column, down = (
        np.concatenate([getattr(line.crossings, name) for line in lines])
        for name in ("row", "column", "down")
    )
    around = np.concatenate([_around(line) for line in lines], axis=1)
    level = np.repeat([line.level for line in lines], counts)
    samples = around[1::3] - level
    fraction = samples[1] / (samples[1] - samples[2])
    fine = np.repeat(counts >= _FEWEST, counts) & _runs_across(around)
    _refine(fraction, samples, fine, starts)
    many = np.add.reduceat(fine, starts, dtype=np.int64) >= _FEWEST // 2
    kept = np.flatnonzero(fine | ~np.repeat(many, counts))
    row, column, down, fraction = row[kept], column[kept], down[kept], fraction[kept]
    points = np.empty((len(kept), 2))
    points[:, 0] = column + np.where(down, 0.0, fraction)
    points[:, 1] = row + np.where(down, fraction, 0.0)
    return np.split(points, np.searchsorted(kept, starts[1:]))


def _around(line: LevelLine) -> FloatArray:
    """Return the 4 × 3 pixels around every edge, (12, n): by threes across it, from before its first on."""
    flat, width = flat_view(line.field)
    steps, sides = np.arange(-1, 3)[:, None], np.arange(-1, 2)
    offsets = np.stack([steps + width * sides, width * steps + sides], axis=-1).reshape(12, 2)
    base = line.crossings.row * width + line.crossings.column
    at = offsets.take(line.crossings.down.view(np.int8), axis=1)
    at += base
    values = flat.take(at)
    return values.astype(np.float64) if line.noise is None else line.noise.taken_off(values)


def _refine(fraction: FloatArray, samples: FloatArray, fine: NDArray[np.bool_], starts: IntArray) -> None:
    """Put crossings where the three-pixel means cross, or the cubic where that serves better, in place.

    Averaging makes a step three pixels wide. That is needed where the picture is so sharp that the step
    takes less than two; where the lens has blurred it, or the level is far from its middle, the cubic
    is as good and sees less of a skin that is darker than the flesh behind it.
    """
    clean = (samples[0] * samples[1] > 0) & (samples[2] * samples[3] > 0)
    blur = _ramp(_sharpness(samples, clean, starts), _BLURRED, _SHARP)
    chosen = np.flatnonzero(clean & fine)
    a, b, c, d = samples[:, chosen]
    rise = a - d
    means = (a + b + c) / rise
    off_middle = np.abs(a + d) / (2.0 * np.abs(rise))
    sharp = np.repeat(blur, np.diff(starts, append=len(clean)))[chosen]
    share = sharp * _ramp(-off_middle, -_OFF, -_NEARLY_OFF)
    share[(means < -_BEYOND) | (means > 1 + _BEYOND)] = 0.0
    rest = np.flatnonzero(share < 1.0)  # few, where the picture is sharp
    cubic = _cubic_crossing(a[rest], b[rest], c[rest], d[rest], fraction[chosen[rest]])
    means[rest] = np.where(share[rest] > 0.0, share[rest] * means[rest] + (1 - share[rest]) * cubic, cubic)
    fraction[chosen] = means


def _sharpness(samples: FloatArray, clean: NDArray[np.bool_], starts: IntArray) -> FloatArray:
    """Return which part of a step lies between the two pixels, over each line; 0 where it has no step."""
    between = np.add.reduceat(np.where(clean, np.abs(samples[1] - samples[2]), 0.0), starts)
    whole = np.add.reduceat(np.where(clean, np.abs(samples[0] - samples[3]), 0.0), starts)
    return np.divide(between, whole, out=np.zeros_like(whole), where=whole > 0.0)


def _cubic_crossing(
    a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray, start: FloatArray
) -> FloatArray:
    """Return where the cubic through four samples is zero, between the middle two (Newton's method)."""
    linear = -a / 3 - b / 2 + c - d / 6
    square = a / 2 - b + c / 2
    cube = (b - c) / 2 + (d - a) / 6
    t = start
    for _ in range(_NEWTON_STEPS):
        slope = linear + t * (2 * square + 3 * t * cube)
        value = b + t * (linear + t * (square + t * cube))
        t = np.clip(t - value / np.where(slope != 0.0, slope, np.inf), 0.0, 1.0)
    return t


def _ramp(value: FloatArray, low: float, high: float) -> FloatArray:
    """Return 0 below `low`, 1 above `high`, and the straight line between."""
    return np.clip((value - low) / (high - low), 0.0, 1.0)


def _runs_across(around: FloatArray) -> NDArray[np.bool_]:
    """Return whether the field changes faster along the crossed edge than across it.

    Slopes of the plane fitted to the 4 × 3 pixels around the edge by least squares; in whole numbers, so that
    where both are alike in whole grey levels no rounding decides.
    """
    cells = around.reshape(4, 3, -1)
    rows, columns = cells.sum(axis=1), cells.sum(axis=0)
    along = np.abs(3.0 * (rows[3] - rows[0]) + (rows[2] - rows[1]))  # 30 times the plane's slope
    across = np.abs(columns[2] - columns[0])  # 8 times
    return np.asarray(8 * along >= 30 * _DOMINANCE * across)
