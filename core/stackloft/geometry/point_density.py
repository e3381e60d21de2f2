"""Where a loop deserves its points: closer together where it bends.

An even share of arc length starves the tips of slender sections. Points are spread over a mixture of arc
length and turning instead (equidistribution of a monitor function; de Boor 1973, Good approximation by
splines with variable knots).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

TURNING = 0.5
"""Share of the points that goes by turning; the rest goes by arc length."""
SMOOTHING = 4.0
"""Standard deviation, in samples of 128, over which turning is averaged: about a point's spacing."""


@dataclass(frozen=True, slots=True, eq=False)
class Spread:
    """Maps between fraction of arc length s and share of points t, both from the canonical start."""

    shares: FloatArray
    """(m, K + 1) t at s = k/K, from 0 to 1."""

    def share(self, section: int | IntArray, s: FloatArray) -> FloatArray:
        """Return t at s of the sections, (…) broadcastable; both run on beyond one turn."""
        whole = np.floor(s)
        rest = s - whole
        steps = self.shares.shape[1] - 1
        k = np.minimum((rest * steps).astype(np.int64), steps - 1)
        begin = self.shares[section, k]
        rise = (self.shares[section, k + 1] - begin) * steps
        return np.asarray(whole + (begin + rise * (rest - k / steps)))

    def fraction(self, section: int | IntArray, t: FloatArray) -> FloatArray:
        """Return s at t of the sections, (…) broadcastable; both run on beyond one turn."""
        whole = np.floor(t)
        rest = t - whole
        steps = self.shares.shape[1] - 1
        apart = 2.0 * np.arange(len(self.shares))  # all sections' shares in one increasing row
        row = (self.shares + apart[:, None]).ravel()
        k = np.searchsorted(row, rest + apart[section], side="right") - 1
        k = np.clip(k - np.asarray(section) * (steps + 1), 0, steps - 1)
        begin = self.shares[section, k]
        rise = 1.0 / (steps * (self.shares[section, k + 1] - begin))
        return np.asarray(whole + (k / steps + rise * (rest - begin)))


def spread_by_turning(tangents: FloatArray, corners: list[FloatArray]) -> Spread:
    """Return how the points of each section should be spread.

    Parameters
    ----------
    tangents : (m, K, 2) array
        dP/ds at K even fractions of arc length from the canonical start.
    corners : list of (c_i,) arrays
        Corner places as fractions; what turns at a corner asks for no points beside the corner's own.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(128) / 128
    >>> circle = np.stack([-np.sin(t), np.cos(t)], axis=1)[None]
    >>> spread = spread_by_turning(circle, [np.array([])])
    >>> bool(abs(spread.fraction(0, np.array([0.25, 1.5])) - [0.25, 1.5]).max() < 1e-12)
    True
    """
    count = tangents.shape[1]
    heading = tangents[..., 0] + 1j * tangents[..., 1]
    turn = np.abs(np.angle(np.roll(heading, -1, axis=1) / heading))
    if any(len(marks) for marks in corners):
        turn = turn * np.stack([_away(marks, count) for marks in corners])
    frequency = np.fft.rfftfreq(count)
    kernel = np.exp(-2.0 * (np.pi * SMOOTHING * frequency) ** 2)
    smooth = np.maximum(np.fft.irfft(np.fft.rfft(turn, axis=1) * kernel, count, axis=1), 0.0)
    total = smooth.sum(axis=1, keepdims=True)
    weight = TURNING * np.minimum(total / (2.0 * np.pi), 1.0)  # a polygon bends nowhere but at its corners
    density = (1.0 - weight) / count + weight * smooth / np.where(total > 0.0, total, 1.0)
    shares = np.concatenate([np.zeros((len(density), 1)), np.cumsum(density, axis=1)], axis=1)
    return Spread(shares / shares[:, -1:])


def _away(marks: FloatArray, count: int) -> FloatArray:
    """Return 0 within 1.5 samples of a corner, rising to 1 at 3, for each interval between samples."""
    distance = np.abs((np.arange(count) + 0.5 - marks[:, None] * count + 0.5 * count) % count - 0.5 * count)
    return np.asarray(np.clip((distance - 1.5) / 1.5, 0.0, 1.0).prod(axis=0))
