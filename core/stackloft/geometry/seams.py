"""Where each section's loop starts: phases that make neighbouring sections correspond.

The phase of a section against its neighbour maximises the circular correlation of position, of tangent
and of corners, and how alike the two loops are whatever the turn between them: the power of the tangents'
correlation. All phases are tried at once by FFT. Position holds near-circular loops still (no spin), tangents
and corners follow a real twist; likeness keeps a long bent section, carried round by most of a right angle
(a coil's), from being laid on the neighbour's part of the same ring instead of on its own tips.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
ComplexArray = NDArray[np.complex128]

TIE = 0.02
"""Two phases whose scores (0 to 4) differ by less are a near tie."""
ALIKE = 0.98
"""Shapes whose tangents correlate better than this fraction of the best are the same shape, turned."""
TURNS_APART = np.radians(15.0)
"""Two turns, one to the left and one to the right, whose angles differ by less cannot be told apart."""
APART = 1.0 / 16.0
"""Phases closer than this fraction of a turn are the same maximum."""


@dataclass(frozen=True, slots=True, eq=False)
class SeamPhases:
    """Phases of a stack."""

    phases: FloatArray
    """(m,) fraction of the loop between its canonical start and its seam."""
    tied: IntArray
    """Pairs (i, i + 1), given by i, that two distinct phases fit almost equally well."""


def solve_phases(points: FloatArray, tangents: FloatArray, corners: list[FloatArray]) -> SeamPhases:
    """Return the phases of m sections sampled at K equal fractions of their loops.

    Parameters
    ----------
    points : (m, K, 2) array
        Positions relative to each loop's centroid, mm.
    tangents : (m, K, 2) array
        dP/ds; only its direction is used.
    corners : list of (c_i,) arrays
        Corner positions as fractions of the loop.

    Returns
    -------
    SeamPhases
        Section i's point at phases[i] + s corresponds to section i + 1's at phases[i + 1] + s. The
        score depends on differences of phase alone, so solving pair after pair is the optimum over
        the whole stack; among near ties the one nearest to the twist above and below is taken.

    Examples
    --------
    >>> t = 2 * np.pi * np.arange(64) / 64
    >>> square = np.stack([np.cos(t) + 0.1 * np.cos(3 * t), np.sin(t) - 0.1 * np.sin(3 * t)], axis=1)
    >>> stack = np.stack([square, np.roll(square, 8, axis=0)])
    >>> steps = np.roll(stack, -1, axis=1) - np.roll(stack, 1, axis=1)
    >>> solve_phases(stack, steps, [np.array([]), np.array([])]).phases.round(3)
    array([0.   , 0.125])
    """
    shape = _correlation(_directions(tangents))
    steps, tied = _best_steps(_scores(points, shape, corners))
    phases = np.concatenate([[0.0], np.cumsum(steps)])
    return SeamPhases(phases, np.flatnonzero(tied | _turns_unsure(shape)))


def _scores(points: FloatArray, shape: ComplexArray, corners: list[FloatArray]) -> FloatArray:
    """Return (m - 1, K) scores of shifting section i + 1 against section i by k samples.

    `shape` is the correlation of their tangents' directions.
    """
    score = _correlation(_as_complex(points)).real + shape.real + _squared(shape)
    if any(len(c) for c in corners):
        score += _correlation(_corner_signal(corners, points.shape[1])).real
    return np.asarray(score)


def _as_complex(plane: FloatArray) -> ComplexArray:
    """Return the plane's vectors as complex numbers."""
    numbers = np.empty(plane.shape[:-1], dtype=np.complex128)
    numbers.real, numbers.imag = plane[..., 0], plane[..., 1]
    return numbers


def _directions(tangents: FloatArray) -> ComplexArray:
    length = np.sqrt(tangents[..., 0] ** 2 + tangents[..., 1] ** 2)
    return _as_complex(tangents / length[..., None])


def _turns_unsure(match: ComplexArray) -> NDArray[np.bool_]:
    """Return for each pair whether the same shape may have turned left as well as right.

    The modulus of the tangents' correlation tells how alike two loops are whatever the turn between
    them, its phase tells the turn. A shape that matches unturned, or a round one that matches at any
    turn, leaves no doubt.
    """
    alike = np.sqrt(_squared(match))
    best = alike.max(axis=1, keepdims=True)
    peak = (
        (alike >= np.roll(alike, 1, axis=1)) & (alike > np.roll(alike, -1, axis=1)) & (alike > ALIKE * best)
    )
    turn = np.zeros_like(alike)
    turn[peak] = np.angle(match[peak])
    left = np.where(peak & (turn > 0.0), turn, np.inf).min(axis=1)
    right = np.where(peak & (turn < 0.0), -turn, np.inf).min(axis=1)
    with np.errstate(invalid="ignore"):
        same = np.abs(left - right) < TURNS_APART
    unturned = alike[:, [-2, -1, 0, 1, 2]].max(axis=1)  # a corner's place is known to a sample or two
    return np.asarray(same & (unturned < ALIKE * best[:, 0]))


def _correlation(signal: ComplexArray) -> ComplexArray:
    """Return the normalised circular correlation of each row with the next, at every shift."""
    norm = np.sqrt(_squared(signal).sum(axis=1))
    spectrum = np.fft.fft(signal, axis=1) / np.where(norm > 0, norm, 1.0)[:, None]
    return np.asarray(np.fft.ifft(np.conj(spectrum[:-1]) * spectrum[1:], axis=1))


def _squared(numbers: ComplexArray) -> FloatArray:
    """Return |z|²; NumPy's |z| takes care of numbers that are not met here, and several times as long."""
    return np.asarray(numbers.real**2 + numbers.imag**2)


def _corner_signal(corners: list[FloatArray], samples: int) -> ComplexArray:
    """Return a bump of about 2 % of the loop at every corner, (m, samples)."""
    grid = np.arange(samples) / samples
    rows = np.zeros((len(corners), samples))
    for k, marks in enumerate(corners):
        away = np.abs((grid - marks[:, None] + 0.5) % 1.0 - 0.5)
        rows[k] = np.exp(-0.5 * (away / 0.02) ** 2).sum(axis=0)
    return rows.astype(np.complex128)


def _best_steps(score: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return each pair's best shift as a fraction in [-½, ½), and whether another fits almost as well."""
    before, after = np.roll(score, 1, axis=1), np.roll(score, -1, axis=1)
    peaks = (score >= before) & (score > after)
    best = np.where(peaks, score, -np.inf).max(axis=1, initial=-np.inf, keepdims=True)
    near = peaks & (score >= best - TIE)
    curvature = before - 2.0 * score + after
    shift = 0.5 * (before - after) / np.where(curvature < 0.0, curvature, -1.0)
    samples = score.shape[1]
    fraction = ((np.arange(samples) + np.clip(shift, -0.5, 0.5)) / samples + 0.5) % 1.0 - 0.5
    steps = fraction[np.arange(len(score)), near.argmax(axis=1)]
    steps[~near.any(axis=1)] = 0.0
    tied = np.zeros(len(score), dtype=bool)
    sure = np.flatnonzero(near.sum(axis=1) < 2)
    for pair in np.flatnonzero(near.sum(axis=1) > 1):
        candidates = fraction[pair, near[pair]]
        at = int(np.searchsorted(sure, pair))
        beside = sure[
            max(at - 1, 0) : at + 1
        ]  # from below as from above: turned over, the stack stays the same
        twist = steps[beside].mean() if len(beside) else 0.0
        steps[pair] = candidates[np.argmin(np.round(np.abs(candidates - twist), 9))]
        apart = np.abs((candidates - steps[pair] + 0.5) % 1.0 - 0.5)
        tied[pair] = (apart > APART).any()
    return steps, tied
