r"""A reference object's size in pixels, between the pixels.

::

     grey  ____                  On lines across the object's edge the grey level is half-way between a
           inside \              band within and a band outside; a circle, or two parallel lines, are fitted
                   * half-way    to these points. The bands lie 1.5 to 4 pixels from the edge.
                    \___outside
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.circle_fit import fit_circle
from stackloft.model.arrays import FloatArray
from stackloft.model.reference import ReferenceKind
from stackloft_plugins.readers.reference_sighting import PixelSize

_REACH = 5.0
_STEP = 0.125
_BAND = (1.5, 4.0)
_ROUNDS = 3
_KEPT_OFF = 0.12  # of a side, at its corners
_FEWEST = 8


def disc_size(grey: NDArray[np.float32], centre: tuple[float, float], radius: float) -> PixelSize | None:
    """Return a disc's diameter; `centre` (x, y) and `radius` are a first guess, pixels."""
    disc = disc_at(grey, centre, radius)
    return None if disc is None else disc[1]


def disc_at(
    grey: NDArray[np.float32], centre: tuple[float, float], radius: float
) -> tuple[tuple[float, float], PixelSize] | None:
    """Return a disc's centre (x, y) and diameter; `centre` and `radius` are a first guess, pixels."""
    x, y = centre
    angle = np.linspace(0, 2 * np.pi, max(64, round(4 * radius)), endpoint=False)
    normals = np.column_stack([np.cos(angle), np.sin(angle)])
    for _ in range(_ROUNDS):
        points = edge_points(grey, np.array([x, y]) + radius * normals, normals)
        if len(points) < max(_FEWEST, len(angle) // 2):
            return None
        circle = fit_circle(points)
        x, y, radius = circle.x, circle.y, circle.radius
    independent = min(len(points), 2 * np.pi * radius / 2)  # neighbouring lines share pixels
    uncertainty = 2 * circle.spread / np.sqrt(independent)
    size = PixelSize(2 * radius, float(uncertainty), circle.spread / (2 * radius), circle.oblique)
    return (x, y), size


def bar_size(
    grey: NDArray[np.float32],
    box: tuple[tuple[float, float], tuple[float, float], float],
    kind: ReferenceKind,
) -> PixelSize | None:
    """Return a square's side or a ruler's length; `box` is a first guess: middle, sides, degrees."""
    middle, sides, degrees = np.array(box[0]), np.array(box[1]), np.radians(box[2])
    across = np.array([np.cos(degrees), np.sin(degrees)])
    axes = np.array([across, [-across[1], across[0]]])
    found = [_between(grey, middle, axes, sides, axis) for axis in (0, 1)]
    if kind is ReferenceKind.RULER:
        long = found[int(np.argmax(sides))]
        return None if long is None else PixelSize(long.size, long.uncertainty, long.misfit, 0.0)
    first, second = found
    if first is None or second is None:
        return None
    size = 0.5 * (first.size + second.size)
    unlike = abs(first.size - second.size) / size
    uncertainty = 0.5 * float(np.hypot(first.uncertainty, second.uncertainty))
    return PixelSize(size, uncertainty, max(first.misfit, second.misfit), unlike)


def edge_points(grey: NDArray[np.float32], starts: FloatArray, normals: FloatArray) -> FloatArray:
    """Return where, on lines through `starts` along outward `normals`, the grey level is half-way, (k, 2).

    Lines that leave the picture, or whose level is not crossed within 2 pixels, give no point.
    """
    t = np.arange(-_REACH, _REACH + _STEP / 2, _STEP)
    x, y = ((starts[:, k, None] + t * normals[:, k, None]).astype(np.float32) for k in (0, 1))
    rows, columns = grey.shape
    inside = (x >= 0) & (x <= columns - 1) & (y >= 0) & (y <= rows - 1)
    whole = inside.all(axis=1)
    seen = cv2.remap(grey, x[whole], y[whole], cv2.INTER_LINEAR).astype(np.float64)
    if not len(seen):
        return np.empty((0, 2))
    inner, outer = (np.median(seen[:, (side >= _BAND[0]) & (side <= _BAND[1])]) for side in (-t, t))
    level = 0.5 * (inner + outer)
    near = np.abs(t) <= 3.0
    values, places = seen[:, near] - level, t[near]
    if inner < level:
        values = -values
    crossed = (values[:, :-1] > 0) & (values[:, 1:] <= 0)
    some = crossed.any(axis=1)
    middle = np.where(crossed, np.abs(places[:-1]), np.inf).argmin(axis=1)
    line = np.arange(len(values))
    before, after = values[line, middle], values[line, middle + 1]
    place = places[middle] + _STEP * before / np.where(some, before - after, 1.0)
    points: FloatArray = (starts[whole] + place[:, None] * normals[whole])[some]
    return points


def _between(
    grey: NDArray[np.float32], middle: FloatArray, axes: FloatArray, sides: FloatArray, axis: int
) -> PixelSize | None:
    """Return the distance between the two edges that lie across `axis`."""
    along, aside = axes[axis], axes[1 - axis]
    width = sides[1 - axis] * (1 - 2 * _KEPT_OFF)
    steps = np.linspace(-0.5, 0.5, max(_FEWEST, round(2 * width))) * width
    ends = []
    for sign in (-1.0, 1.0):
        starts = middle + sign * 0.5 * sides[axis] * along + steps[:, None] * aside
        for _ in range(_ROUNDS):
            points = edge_points(grey, starts, np.broadcast_to(sign * along, starts.shape))
            if len(points) < _FEWEST // 2:
                return None
            slope, offset, scatter = _line(points @ aside, points @ along)
            starts = (slope * (starts @ aside) + offset)[:, None] * along + (starts @ aside)[:, None] * aside
        ends.append((slope, slope * float(middle @ aside) + offset, scatter, len(points)))
    (low_slope, low, low_off, _), (high_slope, high, high_off, _) = ends
    tilt = np.cos(np.arctan(0.5 * (low_slope + high_slope)))
    size = float((high - low) * tilt)
    independent = max(width / 2, 1.0)
    scatter = float(np.hypot(low_off, high_off))
    return PixelSize(size, scatter / float(np.sqrt(independent)), scatter / size, 0.0)


def _line(x: FloatArray, y: FloatArray) -> tuple[float, float, float]:
    """Return slope, offset and scatter of the line y(x), without points far off it."""
    kept = np.ones(len(x), dtype=bool)
    slope, offset, off = 0.0, float(np.median(y)), y - np.median(y)
    for _ in range(3):
        slope, offset = (float(value) for value in np.polyfit(x[kept], y[kept], 1))
        off = y - slope * x - offset
        kept = np.abs(off) <= max(3 * 1.4826 * float(np.median(np.abs(off))), 1e-6)
    return slope, offset, float(off[kept].std())
