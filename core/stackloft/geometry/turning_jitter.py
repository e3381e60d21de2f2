r"""By how much each section of a stack is turned out of the smooth course of its neighbours' shapes.

::

     _____     ____       _____       The squared support function about the centroid, as harmonics: turning
    /    /    |    \     /    /       the section by θ turns harmonic n by nθ and leaves its strength alone.
   /____/     |_____|   /____/        Shapes change smoothly from section to section; what turning makes them
              <- turned               do so, with no more turning than that, is the jitter.

Round sections say nothing, and are left as they are; a body's own twist is smooth and stays.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.roughness import third_differences
from stackloft.geometry.shoelace import polygon_area, polygon_centroid

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_DIRECTIONS = 64
_HARMONICS = 8
_ROUNDS = 6
_SPREADS = np.concatenate([[0.0], np.geomspace(1e-4, 0.1, 61)])
"""Standard deviations of the turning, rad, of which the likeliest is taken."""


def turning_jitter(position: FloatArray, polygons: Sequence[FloatArray], noise: float) -> FloatArray:
    """Return the angle, rad, by which each section is turned out of the others' course, (m).

    Parameters
    ----------
    position : array (m), increasing, m ≥ 5
    polygons : sequence of m arrays (k, 2)
    noise : float
        Standard deviation of an outline's place, in the polygons' unit: shapes are not smoother than that.

    Examples
    --------
    >>> t = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    >>> bar = np.column_stack([30 * np.cos(t), 12 * np.sin(t)])
    >>> angles = np.random.default_rng(1).normal(scale=0.05, size=14)
    >>> c, s = np.cos(angles), np.sin(angles)
    >>> stack = [bar @ np.array([[a, b], [-b, a]]) for a, b in zip(c, s)]
    >>> found = turning_jitter(np.arange(14.0), stack, 0.01)
    >>> bool((found - angles).std() < 0.6 * angles.std())       # what is left is smooth: a twist
    True
    """
    weights = third_differences(position, np.eye(len(position)))
    given = np.array([_harmonics(polygon) for polygon in polygons])
    order = np.arange(1, _HARMONICS + 1)
    reach = np.sqrt(np.mean([abs(polygon_area(polygon)) for polygon in polygons]) / np.pi)
    floor = 20 * (2 * reach * noise) ** 2 / _DIRECTIONS
    turned = np.zeros(len(position))
    for _ in range(_ROUNDS):
        shapes = given * np.exp(1j * order * turned[:, None])
        turned = _likeliest(weights, _real(shapes), _real(1j * order * shapes), turned, floor)
    return turned


def _harmonics(polygon: FloatArray) -> ComplexArray:
    """Return the squared support function's harmonics from the first on, (_HARMONICS)."""
    angle = 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    away = polygon - polygon_centroid(polygon)
    reach = (away @ np.array([np.cos(angle), np.sin(angle)])).max(axis=0)
    found: ComplexArray = np.fft.rfft(reach**2)[1 : _HARMONICS + 1] / _DIRECTIONS
    return found


def _real(values: ComplexArray) -> FloatArray:
    return np.concatenate([values.real, values.imag], axis=1)


def _likeliest(
    weights: FloatArray, shapes: FloatArray, slopes: FloatArray, turned: FloatArray, floor: float
) -> FloatArray:
    """Return the angles that make the shapes smoothest, as strong as is likeliest; linear about `turned`."""
    effect = np.einsum("wk,kn->nwk", weights, slopes).reshape(-1, len(turned))
    rough = (weights @ shapes).T.ravel() - effect @ turned
    left, strength, right = np.linalg.svd(effect, full_matrices=False)
    seen = left.T @ rough
    best, angles = np.inf, turned
    for spread in _SPREADS:
        variance = floor
        for _ in range(_ROUNDS):  # the shapes' own roughness, given how strong the turning is
            gain = spread**2 / variance * strength**2
            rest = float((rough**2).sum() - (gain / (1 + gain) * seen**2).sum())
            variance = max(rest / rough.size, floor)
        cost = rough.size * np.log(variance) + rest / variance + np.log1p(gain).sum()
        if cost < best:
            best = cost
            angles = -right.T @ (gain / (1 + gain) * seen / np.maximum(strength, 1e-300))
    return angles
