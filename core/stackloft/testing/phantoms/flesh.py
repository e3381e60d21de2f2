"""Colours of cut bodies: plain flesh, an apple cut along its core, red meat.

The patterns stay on the flesh's side of half-way to the plate (a dark plate for the pale apple, a light one
for red meat), as they do in the photographs that histogram segmentation is meant for.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.ndimage import gaussian_filter

from stackloft.model.arrays import FloatArray

Painter = Callable[[FloatArray, FloatArray, np.random.Generator, float, float], FloatArray]
"""body_frame (3, r, c) mm, depth (r, c) mm, random numbers, texture, rim mm to RGB (3, r, c)."""


def relief(
    rng: np.random.Generator, shape: tuple[int, ...], width: float | tuple[float, float]
) -> FloatArray:
    """Return smooth noise of the given width in pixels, mean 0, standard deviation 1.

    Examples
    --------
    >>> field = relief(np.random.default_rng(1), (60, 80), 3.0)
    >>> round(float(field.mean()), 9) + 0, round(float(field.std()), 9)
    (0.0, 1.0)
    """
    field = gaussian_filter(rng.normal(size=shape), width, mode="wrap")
    field = field - field.mean()
    smooth: FloatArray = field / field.std()
    return smooth


def _rgb(red: float, green: float, blue: float) -> FloatArray:
    return np.array([red, green, blue])[:, None, None]


def _blend(base: FloatArray, other: FloatArray, share: FloatArray) -> FloatArray:
    mixed: FloatArray = base + (other - base) * np.clip(share, 0, 1)
    return mixed


def _skin(depth: FloatArray, rim: float) -> FloatArray:
    """Return how much of the colour is skin: all at the edge, none a rim's width further in."""
    return np.exp(-((depth / rim) ** 2)) if rim > 0 else np.zeros_like(depth)


def plain(
    body: FloatArray, depth: FloatArray, rng: np.random.Generator, texture: float, rim: float
) -> FloatArray:
    """Return mottled flesh of middle brightness that stands out from a white and from a black plate."""
    shape = depth.shape
    mottle = texture * (5 * relief(rng, shape, 6) + 3 * relief(rng, shape, 1.5))
    colour = _rgb(176, 128, 96) + mottle + 0 * body
    return _blend(colour, _rgb(176, 116, 72), 0.95 * _skin(depth, rim))


def apple(
    body: FloatArray, depth: FloatArray, rng: np.random.Generator, texture: float, rim: float
) -> FloatArray:
    """Return pale flesh, the core's outline and its pips near the axis (y), and a yellow-green skin."""
    shape = depth.shape
    x, y, z = body
    grain = texture * (
        2.5 * relief(rng, shape, 12) + 1.5 * relief(rng, shape, 3) + 2.0 * relief(rng, shape, 1.2)
    )
    colour = _rgb(231, 218, 176) + grain
    from_axis = np.hypot(x, z)
    lens = np.clip(1 - (y / 19) ** 2, 0, None)
    line = np.exp(-(((from_axis - 15 * np.sqrt(lens)) / 0.7) ** 2)) * (lens > 0)
    colour = _blend(colour, _rgb(196, 190, 128), texture * 0.55 * line)
    carpel = np.exp(-((((from_axis - 5.0) / 3.6) ** 2 + (y / 9.5) ** 2) ** 3))
    colour = _blend(colour, _rgb(208, 190, 140), texture * 0.75 * carpel)
    pip = np.exp(-((((from_axis - 4.6) / 1.7) ** 2 + ((y + 0.5) / 3.8) ** 2) ** 4)) * (np.abs(x) > np.abs(z))
    colour = _blend(colour, _rgb(186, 146, 98), texture * 0.9 * pip)
    stalk = np.exp(-((from_axis / 1.1) ** 2)) * (np.abs(y) > 9)
    colour = _blend(colour, _rgb(190, 180, 118), texture * 0.5 * stalk)
    colour = _blend(colour, _rgb(218, 212, 150), np.exp(-((depth / 2.5) ** 2)) * 0.7)
    blush = np.clip(0.5 + 0.35 * relief(rng, shape, 60) + 0.01 * x, 0, 1)
    skin = _blend(_rgb(196, 200, 96) + 0 * colour, _rgb(224, 156, 92), blush)
    return _blend(colour, skin, 0.95 * _skin(depth, rim))


def meat(
    body: FloatArray, depth: FloatArray, rng: np.random.Generator, texture: float, rim: float
) -> FloatArray:
    """Return red muscle in bundles with pale seams of fat between them, drier and darker at the surface."""
    shape = depth.shape
    bundles = relief(rng, shape, 9)
    fibre = relief(rng, shape, (1.2, 3.5))
    colour = _rgb(158, 58, 60) + texture * (7 * relief(rng, shape, 28) + 4 * fibre) * _rgb(1.0, 0.75, 0.75)
    slopes = np.gradient(bundles)
    width = np.clip(2.4 + 1.2 * relief(rng, shape, 25), 1.0, 5.0)
    seam = np.exp(-((bundles / (0.55 * np.hypot(*slopes) + 1e-9) / width) ** 2))
    broken = np.clip(0.35 + 0.8 * relief(rng, shape, 16), 0, 1)
    fat = seam * broken * (depth > 1.5 * rim)
    colour = _blend(colour, _rgb(196, 124, 116), texture * 0.75 * gaussian_filter(fat, 0.6))
    fleck = np.clip(relief(rng, shape, 1.8) - 2.3, 0, 1) * (depth > 3 * rim)
    colour = _blend(colour, _rgb(192, 126, 118), texture * 0.8 * fleck)
    colour = colour + 0 * body
    return _blend(colour, _rgb(118, 46, 44), 0.85 * _skin(depth, rim))


PAINTERS: dict[str, Painter] = {"plain": plain, "apple": apple, "meat": meat}
"""Specimen to painter."""
