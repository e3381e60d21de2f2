r"""Where the edge lies in grey profiles taken all around an outline, on ground that is not even.

::

    grey
     f ------.
              \ r       skin, fading inwards
               \
                \____
                 p   \____   the ground changes with the distance: juice, a soft shadow
    --------------e--------> distance outwards, pixels

A profile is p + (ground's change) + (f − p)·Φ + (r − f)·(skin), all blurred alike. Blur and skin are the
lens's
and the body's, the same all around the outline; position, ground and grey levels are each profile's own. For
every position on a grid the grey levels follow linearly (variable projection, Golub & Pereyra 1973), so that
the best of all is found, not the nearest. Where two places fit a profile alike (a dark skin, or juice beside
it?), its neighbours decide: positions that change little along the outline are sought by dynamic programming
(Viterbi 1967).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

FloatArray = NDArray[np.float64]

FURTHEST = 2.0
"""Pixels: edges are sought that near to the profiles' middle."""
_STEP = 0.05
_BLURS = (0.55, 0.65, 0.76, 0.88, 1.0, 1.2, 1.45, 1.8)
_SKINS = (0.0, 1.2, 2.0, 3.2)
_GROUNDS = (0.0, 2.5, 4.5, 8.0)
"""Widths of juice that fades from the edge outwards, pixels; 0: ground that rises or falls evenly."""
CALLED_FOR = 0.8
"""A skin is believed when it brings the misfit of all profiles below this fraction of that without."""
_FINEST = 0.002
"""Of the step: a smaller misfit is no better, for no real edge is just as the model has it."""
_ASTRAY = 40.0
"""Times the usual misfit's square: what a profile may at most say against a place."""


@dataclass(frozen=True, slots=True)
class EdgeShape:
    """What is the same all around an outline; pixels."""

    blur: float
    """Standard deviation"""
    skin: float
    """Width; 0 when none is seen"""


@dataclass(frozen=True, slots=True, eq=False)
class EdgePositions:
    """What was found in m profiles; lengths in pixels."""

    position: FloatArray
    """(m) outwards from the profiles' middle"""
    misfit: FloatArray
    """(m) root mean square of profile less model, over the step from ground to body"""
    shape: EdgeShape


def edge_positions(
    profiles: FloatArray, reach: float, slack: float = 0.3, known: EdgeShape | None = None
) -> EdgePositions:
    """Return the edge of each profile.

    Parameters
    ----------
    profiles : array (m, n)
        Grey levels from `reach` within the outline to `reach` beyond it, in order around a closed outline;
        body above ground.
    reach : float
        Pixels.
    slack : float
        Pixels by which neighbouring profiles' positions usually differ.
    known : EdgeShape, optional
        What an earlier look at the same outline has found; not sought again then.

    Examples
    --------
    >>> x = np.linspace(-6, 6, 49)
    >>> beyond = np.maximum(x - 0.3, 0)
    >>> shaded = 20 + 4 * beyond + 100 * ndtr((0.3 - x) / 0.9)
    >>> edge_positions(np.tile(shaded, (5, 1)), 6.0).position.round(1).tolist()
    [0.3, 0.3, 0.3, 0.3, 0.3]
    """
    scale = np.maximum(np.abs(profiles[:, 0] - profiles[:, -1]), 1e-9)
    levelled = (profiles - profiles.mean(axis=1, keepdims=True)) / scale[:, None]
    shape = known or _edge_shape(levelled, reach)
    left = _misfits(levelled, reach, shape)
    total = _usual_misfit(left)
    usual = max(total**2, profiles.shape[1] * _FINEST**2)
    at = _smooth_way(np.minimum(left / usual, _ASTRAY), slack)
    line = np.arange(len(left))
    misfit = np.sqrt(left[line, at] / profiles.shape[1])
    return EdgePositions(_between(_places(), left, at), misfit, shape)


def _edge_shape(levelled: FloatArray, reach: float) -> EdgeShape:
    """Return the blur, and the skin if one is called for, that describe the profiles best."""
    shapes = [EdgeShape(blur, skin) for skin, blur in product(_SKINS, _BLURS)]
    totals = {shape: _usual_misfit(_misfits(levelled, reach, shape)) for shape in shapes}
    bare = min((shape for shape in shapes if not shape.skin), key=totals.__getitem__)
    best = min(shapes, key=totals.__getitem__)
    return bare if totals[best] > CALLED_FOR * totals[bare] else best


def _usual_misfit(left: FloatArray) -> float:
    return float(np.median(np.sqrt(left.min(axis=1))))


def _places() -> FloatArray:
    return np.linspace(-FURTHEST, FURTHEST, round(2 * FURTHEST / _STEP) + 1)


def _misfits(profiles: FloatArray, reach: float, shape: EdgeShape) -> FloatArray:
    """Return each profile's squared misfit with its edge at each place, on the best ground, (m, places)."""
    m, count = profiles.shape
    explained = np.zeros((m, len(_places())))
    for ground in _GROUNDS:
        fitted = profiles @ _bases(count, reach, shape, ground)
        fitted *= fitted
        np.maximum(explained, fitted.reshape(m, -1, explained.shape[1]).sum(axis=1), out=explained)
    return np.asarray(np.maximum((profiles**2).sum(axis=1)[:, None] - explained, 0.0))


def _smooth_way(cost: FloatArray, slack: float) -> NDArray[np.int64]:
    """Return the place of each profile, (m), such that places and their changes along the outline cost least.

    The outline is gone around once more, so that first and last are neighbours too.
    """
    m = len(cost)
    apart = _places()[:, None] - _places()[None, :]
    change = (apart / slack) ** 2
    order = np.arange(-(m // 2), m + m // 2) % m
    spent = cost[order[0]].copy()
    came = np.zeros((len(order), cost.shape[1]), dtype=np.int64)
    for step, k in enumerate(order[1:], start=1):
        through = spent[None, :] + change
        came[step] = through.argmin(axis=1)
        spent = through.min(axis=1) + cost[k]
    way = np.empty(len(order), dtype=np.int64)
    way[-1] = int(spent.argmin())
    for step in range(len(order) - 1, 0, -1):
        way[step - 1] = came[step, way[step]]
    return way[m // 2 : m // 2 + m]


def _between(places: FloatArray, left: FloatArray, at: NDArray[np.int64]) -> FloatArray:
    """Return the positions, put between the places by the parabola where a place is the lowest near it."""
    inner = np.clip(at, 1, len(places) - 2)
    line = np.arange(len(left))
    before, least, after = (left[line, inner + j] for j in (-1, 0, 1))
    bend = before - 2 * least + after
    shift = np.where(bend > 0, 0.5 * (before - after) / np.where(bend > 0, bend, 1.0), 0.0)
    refined: FloatArray = places[inner] + _STEP * np.clip(shift, -0.5, 0.5)
    return refined


@lru_cache(maxsize=2 * len(_BLURS) * len(_SKINS) * len(_GROUNDS))
def _bases(count: int, reach: float, shape: EdgeShape, ground: float) -> FloatArray:
    """Return an orthonormal basis of the profiles with an edge at each place, (count, 3 or 4 · places)."""
    distance = np.linspace(-reach, reach, count)
    beyond = distance[None, :] - _places()[:, None]
    blur, skin = shape.blur, shape.skin
    z = beyond / blur
    columns = [np.ones_like(z), ndtr(-z)]
    if ground:
        columns.append(_fading(beyond, ground, blur))
    else:
        columns.append(beyond * ndtr(z) + blur * np.exp(-0.5 * z**2) / np.sqrt(2 * np.pi))
    if skin:
        columns.append(_fading(-beyond, skin, blur))
    bases: FloatArray = np.linalg.qr(np.stack(columns, axis=2))[0]
    flat = np.ascontiguousarray(bases.transpose(1, 2, 0).reshape(count, -1))
    flat.setflags(write=False)
    return flat


def _fading(depth: FloatArray, width: float, blur: float) -> FloatArray:
    """Return exp(−(t/width)²) for t > 0, blurred (product of two Gaussians)."""
    own = 0.5 * width**2
    total = own + blur**2
    return np.asarray(np.exp(-0.5 * depth**2 / total) * ndtr(depth * np.sqrt(own / total) / blur))
