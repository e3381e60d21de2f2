"""Which closed polygons cross themselves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

AT_ONCE = 16_000
"""Pairs of edges looked at together, so that what is in between stays in the processor's cache."""
_SHARP, _BACK = 0.6, -0.4  # cosines: where a loop turns by 53° and 114° or more at a vertex


def crosses_itself(points: FloatArray) -> BoolArray:
    """Return for each polygon whether two of its edges cross properly.

    Parameters
    ----------
    points : (m, N, 2) array
        Vertices of m closed polygons.

    Returns
    -------
    (m,) bool array
        Touching in a vertex or along an edge is no crossing.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> crosses_itself(np.stack([square, square[[0, 2, 1, 3]]])).tolist()
    [False, True]
    """
    found = ~_star_shaped(points)
    unsure = points[found]
    together = max(1, AT_ONCE // max(1, points.shape[1] ** 2))
    parts = [_cross(unsure[k : k + together]) for k in range(0, len(unsure), together)]
    found[found] = np.concatenate([np.zeros(0, dtype=np.bool_), *parts])
    return found


def _star_shaped(points: FloatArray) -> BoolArray:
    """Return for each polygon whether it runs once round the mean of its vertices, and never back."""
    arm = points - points.mean(axis=1, keepdims=True)
    x, y = arm[..., 0], arm[..., 1]
    next_x, next_y = (np.concatenate([each[:, 1:], each[:, :1]], axis=1) for each in (x, y))
    turn = x * next_y - y * next_x
    slack = 1e-12 * np.abs(arm).max(axis=(1, 2), initial=0.0)[:, None] ** 2
    onwards = (turn > slack).all(axis=1) | (turn < -slack).all(axis=1)
    once = ((y < 0.0) & (next_y >= 0.0)).sum(axis=1) == 1
    return np.asarray(onwards & once)


def _cross(points: FloatArray) -> BoolArray:
    edge = np.concatenate([points[:, 1:], points[:, :1]], axis=1) - points
    side_of_start = _sides(points, edge)
    side_of_end = np.concatenate([side_of_start[:, :, 1:], side_of_start[:, :, :1]], axis=2)
    apart = side_of_start * side_of_end < 0  # [i, j]: edge j's ends lie on both sides of edge i's line
    return np.asarray((apart & apart.transpose(0, 2, 1)).any(axis=(1, 2)))


def _sides(points: FloatArray, edge: FloatArray) -> NDArray[np.int8]:
    """Return [i, j]: on which side of edge i point j lies, 1 or -1; 0 within rounding."""
    area = edge[:, :, None, 0] * (points[:, None, :, 1] - points[:, :, None, 1])
    area -= edge[:, :, None, 1] * (points[:, None, :, 0] - points[:, :, None, 0])
    slack = 1e-12 * np.abs(points - points[:, :1]).max(axis=(1, 2), initial=0.0) ** 2
    above = (area > slack[:, None, None]).view(np.int8)
    side: NDArray[np.int8] = above - (area < -slack[:, None, None]).view(np.int8)
    return side


def is_entangled(points: FloatArray) -> bool:
    """Return whether a smooth loop, (k, 2), crosses itself, or turns back on itself at a vertex.

    A curve that crosses itself by a slip of its fit turns sharply somewhere; only then is it looked for.

    Examples
    --------
    >>> t = 2.0 * np.pi * np.arange(15) / 15
    >>> ring = np.column_stack([np.cos(t), np.sin(t)])
    >>> is_entangled(ring), is_entangled(np.column_stack([np.cos(t), np.sin(2.0 * t)]))
    (False, True)
    """
    step = np.roll(points, -1, axis=0) - points
    following = np.roll(step, -1, axis=0)
    length = np.maximum(
        np.linalg.norm(step, axis=1) * np.linalg.norm(following, axis=1), np.finfo(float).tiny
    )
    sharpest = float(((step * following).sum(axis=1) / length).min())
    return sharpest < _BACK or (sharpest < _SHARP and bool(crosses_itself(points[None])[0]))
