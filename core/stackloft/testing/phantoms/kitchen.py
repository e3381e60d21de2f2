r"""What a kitchen table adds to a photograph: reflections, a shadow, a ring of juice, crumbs, mishaps.

::

        .  ______          glare     lamps mirrored on wet flesh: small, soft, nearly white
         _/ o    \_ :      shadow    beside the body, on one side, soft
      . (     o    ):      juice     a thin film around the body, of its own colour, uneven
         \_______/ ::(     crumbs    specks of flesh on the plate
          ´´´´´´ .         mishaps   a slice out of focus, one with a deep shadow across the plate, some with
                                     a lamp mirrored on the plate, at the picture's right edge
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter, shift

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.flesh import relief

_FILM = np.array([206.0, 120.0, 110.0])[:, None, None]
_CRUMB = np.array([150.0, 80.0, 66.0])[:, None, None]
_LAMP = 252.0


@dataclass(frozen=True, slots=True)
class Kitchen:
    """How untidy the table is; each strength may be 0.

    Examples
    --------
    >>> Kitchen(blurred=4).blur(0.7, 4), Kitchen(blurred=4).blur(0.7, 5)
    (7.0, 0.7)
    """

    glare: float = 2.5
    """Reflections on 10 cm² of flesh"""
    shadow: float = 0.22
    """How much darker the plate is in the body's shadow, relative"""
    juice: float = 0.28
    """How much of the plate's colour the film hides at the body's edge"""
    crumbs: int = 12
    blurred: int = 0
    """Number of the slice that is out of focus, from 1; 0: none"""
    shaded: int = 0
    """Number of the slice with a deep shadow over half the plate"""
    lamps: tuple[int, ...] = ()
    """Numbers of the slices with a lamp mirrored on the plate"""
    lamp: float = 9.0
    """How far the mirrored lamp reaches into the picture, mm"""

    def plate(
        self, ground: FloatArray, covered: FloatArray, pixel_size: float, seed: int, index: int
    ) -> FloatArray:
        """Return the plate's colours, (3, rows, columns), with shadow, juice and crumbs."""
        rng = np.random.default_rng([seed, index, 31])
        away = distance_transform_edt(covered <= 0.5) * pixel_size
        width = np.clip(2.5 + 1.2 * relief(rng, covered.shape, 4.0 / pixel_size), 0.6, 6.0)
        film = self.juice * np.exp(-((away / width) ** 2))
        ground = ground + (_FILM - ground) * film
        light = 1 - self.shadow * self._cast(covered, pixel_size, seed)
        if index == self.shaded:
            light = light * self._half(covered.shape)
        ground = ground * light
        specks = self._specks(rng, covered, away, pixel_size)
        painted: FloatArray = ground + (_CRUMB - ground) * specks
        if index in self.lamps:
            painted = painted + (_LAMP - painted) * self._mirrored(covered.shape, pixel_size)
        return painted

    def flesh(
        self, body: FloatArray, depth: FloatArray, pixel_size: float, seed: int, index: int
    ) -> FloatArray:
        """Return the flesh's colours with reflections on it."""
        rng = np.random.default_rng([seed, index, 32])
        inside = np.argwhere(depth > 1.0)
        if not len(inside):
            return body
        y, x = np.indices(depth.shape) * pixel_size
        shine = np.zeros_like(depth)
        count = rng.poisson(self.glare * len(inside) * pixel_size**2 / 1000)
        for row, column in inside[rng.integers(0, len(inside), count)] * pixel_size:
            long, short, angle = rng.uniform(0.8, 2.4), rng.uniform(0.5, 1.0), rng.uniform(0, np.pi)
            along = (x - column) * np.cos(angle) + (y - row) * np.sin(angle)
            aside = (y - row) * np.cos(angle) - (x - column) * np.sin(angle)
            shine = np.maximum(shine, np.exp(-(((along / long) ** 2 + (aside / short) ** 2) ** 2)))
        bright: FloatArray = body + (_LAMP - body) * 0.95 * shine
        return bright

    def blur(self, usual: float, index: int) -> float:
        """Return the standard deviation of the lens's blur, pixels."""
        return 10 * usual if index == self.blurred else usual

    def _cast(self, covered: FloatArray, pixel_size: float, seed: int) -> FloatArray:
        """Return the body's soft shadow, 0 to 1: the lamp is where it is for the whole stack."""
        angle = np.random.default_rng([seed, 998]).uniform(0, 2 * np.pi)
        way = 2.5 / pixel_size * np.array([np.sin(angle), np.cos(angle)])
        cast: FloatArray = gaussian_filter(shift(covered, way, order=1), 1.2 / pixel_size)
        return cast

    def _half(self, shape: tuple[int, ...]) -> FloatArray:
        """Return the light where something stands before the lamp."""
        across = np.linspace(-1, 1, shape[1])[None, :] + 0.3 * np.linspace(-1, 1, shape[0])[:, None]
        return 1 - 0.42 / (1 + np.exp(-across * 30))

    def _mirrored(self, shape: tuple[int, ...], pixel_size: float) -> FloatArray:
        """Return how much of each pixel of the plate is lamp: half an ellipse upon the right edge."""
        y, x = np.indices(shape) * pixel_size
        aside, along = x - x.max(), y - 0.5 * y.max()
        far = np.hypot(aside / self.lamp, along / (1.4 * self.lamp))
        lamp: FloatArray = np.clip((1 - far) * self.lamp / pixel_size + 0.5, 0, 1)
        return lamp

    def _specks(
        self, rng: np.random.Generator, covered: FloatArray, away: FloatArray, pixel_size: float
    ) -> FloatArray:
        """Return how much of each pixel is crumb; crumbs lie clear of the body."""
        free = np.argwhere(away > 2.0)
        specks = np.zeros_like(covered)
        if not len(free) or not self.crumbs:
            return specks
        y, x = np.indices(covered.shape) * pixel_size
        for row, column in free[rng.integers(0, len(free), self.crumbs)] * pixel_size:
            size = rng.uniform(0.3, 1.0)
            far = np.hypot(x - column, y - row)
            specks = np.maximum(specks, np.clip((size - far) / pixel_size + 0.5, 0, 1))
        return specks
