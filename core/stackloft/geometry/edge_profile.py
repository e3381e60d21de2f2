r"""Where the edge lies in a blurred grey profile across a body's boundary.

::

    grey
     f ------.
              \__ r   skin: its grey r at the edge, its width w
                 \
                  \      blur of standard deviation σ
                   \____ p   background
    -----------------e--------> distance outwards, pixels

The profile is p + (f − p)·Φ + (r − f)·(skin), all blurred alike; e, w and σ are found by Gauss-Newton,
the grey levels linearly inside (variable projection, Golub & Pereyra 1973). A skin is tried even (a layer of
one grey) and fading (exp −(t/w)²), and is believed only when the profile calls for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

FloatArray = NDArray[np.float64]
Skin = Callable[[FloatArray, float, float], FloatArray]

CALLED_FOR = 0.6
"""A skin is believed when it brings the misfit below this fraction of that without."""
PLAIN = 0.002
"""An edge without skin that misfits by less than this fraction of the step needs none."""
ITERATIONS = 40
_LOW = np.array([-2.0, 0.7, 0.35])
_HIGH = np.array([2.0, 6.0, 3.0])
_STEP = (1e-4, 1e-3, 1e-4)
_STARTS = ((0.0, 1.5, 0.8), (0.0, 3.5, 0.8))


@dataclass(frozen=True, slots=True)
class EdgeFit:
    """An edge in a profile; lengths in the unit of the distances."""

    position: float
    """Distance of the edge from where the profile was centred, outwards."""
    blur: float
    """Standard deviation of the blur."""
    skin: float
    """Width of the skin; 0 when there is none to be seen."""
    misfit: float
    """Root mean square of profile less model, over the step from background to body."""


def fit_edge(distance: FloatArray, profile: FloatArray) -> EdgeFit | None:
    """Return the edge of a profile.

    Parameters
    ----------
    distance : (n,) array
        Outward distances, increasing, about ±6 pixels.
    profile : (n,) array
        Mean grey level at each distance.

    Returns
    -------
    EdgeFit or None
        None when the profile is no edge: no step, or an edge more than 2 from the centre.

    Examples
    --------
    >>> x = np.linspace(-6, 6, 49)
    >>> profile = 20 + 160 * ndtr((0.3 - x) / 0.9)
    >>> fit = fit_edge(x, profile)
    >>> round(fit.position, 6), round(fit.blur, 6), fit.skin
    (0.3, 0.9, 0.0)
    """
    step = abs(float(profile[0] - profile[-1]))
    if step == 0.0 or not np.isfinite(profile).all():
        return None
    bare = _solve(distance, profile, _no_skin, (0.0, 1.0, 0.8))
    best, skin = bare, 0.0
    for shape in (_even_skin, _fading_skin) if bare[1] > PLAIN * step else ():
        for start in _STARTS:
            trial = _solve(distance, profile, shape, start)
            if trial[1] < min(CALLED_FOR * bare[1], best[1]):
                best, skin = trial, float(trial[0][1])
    position, _, blur = best[0]
    if abs(position) >= _HIGH[0]:
        return None
    return EdgeFit(float(position), float(blur), skin, best[1] / step)


def _no_skin(depth: FloatArray, _width: float, _blur: float) -> FloatArray:
    return np.zeros((len(depth), 0))


def _even_skin(depth: FloatArray, width: float, blur: float) -> FloatArray:
    """Return a layer of one grey from depth 0 to `width`, blurred."""
    return np.asarray(ndtr(depth / blur) - ndtr((depth - width) / blur))[:, None]


def _fading_skin(depth: FloatArray, width: float, blur: float) -> FloatArray:
    """Return exp(−(t/width)²) for depths t > 0, blurred (product of two Gaussians)."""
    own = 0.5 * width**2
    total = own + blur**2
    bell = np.sqrt(own / total) * np.exp(-0.5 * depth**2 / total)
    return np.asarray(bell * ndtr(depth * np.sqrt(own / total) / blur))[:, None]


def _residual(q: FloatArray, distance: FloatArray, profile: FloatArray, skin: Skin) -> FloatArray:
    """Return profile less model at (position, width, blur), the grey levels fitted linearly."""
    depth = q[0] - distance
    basis = np.column_stack([np.ones_like(depth), ndtr(depth / q[2]), skin(depth, q[1], q[2])])
    levels, *_ = np.linalg.lstsq(basis, profile, rcond=None)
    return np.asarray(profile - basis @ levels)


def _solve(
    distance: FloatArray, profile: FloatArray, skin: Skin, start: tuple[float, float, float]
) -> tuple[FloatArray, float]:
    """Return (position, width, blur) and the root mean square misfit, by Levenberg-Marquardt."""
    q = np.array(start)
    residual = _residual(q, distance, profile, skin)
    damping = 1e-3
    for _ in range(ITERATIONS):
        slope = np.column_stack(
            [(_residual(q + h, distance, profile, skin) - residual) / h.max() for h in np.diag(_STEP)]
        )
        normal, gradient = slope.T @ slope, slope.T @ residual
        for _ in range(8):
            damped = normal + damping * np.diag(np.diag(normal) + 1e-12)
            trial = np.clip(q - np.linalg.solve(damped, gradient), _LOW, _HIGH)
            found = _residual(trial, distance, profile, skin)
            if found @ found < residual @ residual:
                break
            damping *= 4.0
        else:
            break
        gain = residual @ residual - found @ found
        q, residual, damping = trial, found, max(0.2 * damping, 1e-9)
        if gain < 1e-9 * (residual @ residual) + 1e-14:
            break
    return q, float(np.sqrt(residual @ residual / len(residual)))
