"""What a camera makes of a slice on a plate: flesh, skin, light, lens and sensor."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.flesh import PAINTERS, Painter, relief
from stackloft.testing.phantoms.kitchen import Kitchen

Rgb = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Realism:
    """How far a photograph departs from exact coverage; every field can be set to nothing.

    Examples
    --------
    >>> Realism.of("apple").specimen, Realism.of("cylinder").specimen
    ('apple', 'plain')
    """

    specimen: str = "plain"
    """Whose flesh: ``apple``, ``meat`` or ``plain``."""
    seed: int = 0
    texture: float = 1.0
    """Strength of the flesh's pattern; 0 is one even colour."""
    rim: float = 0.6
    """Width of the skin, mm."""
    plate: Rgb | None = None
    """The plate's colour, 0–255; None: by the plate's name."""
    light: float = 0.06
    """How much darker the darkest corner is, relative."""
    blur: float = 0.7
    """Standard deviation of the lens's blur, pixels."""
    noise: float = 2.5
    """Standard deviation of the sensor's noise, grey levels of 255."""
    quality: int = 92
    """Of JPEG and WebP, 1–100."""
    kitchen: Kitchen | None = None
    """Reflections, shadow, juice and crumbs; None: none of them."""

    @classmethod
    def of(cls, name: str, seed: int = 0) -> Realism:
        """Return the look that suits the phantom called `name`."""
        return cls(specimen=name if name in PAINTERS else "plain", seed=seed)

    def with_seed(self, seed: int) -> Realism:
        """Return the same look with other random numbers."""
        return replace(self, seed=seed)


PLATES: dict[str, Rgb] = {"white": (238.0, 237.0, 233.0), "black": (20.0, 20.0, 22.0)}
"""Plate name to colour."""


Thing = tuple[FloatArray, FloatArray]
"""Coverage (rows, columns) and colour (3, rows, columns) of an object beside the body."""


def photograph(
    covered: FloatArray,
    body_frame: FloatArray,
    pixel_size: float,
    plate: Rgb,
    look: Realism,
    index: int,
    thing: Thing | None = None,
) -> FloatArray:
    """Return the picture, (rows, columns, 3) from 0 to 255, not yet rounded.

    Parameters
    ----------
    covered : array (rows, columns)
        Exact coverage; the only thing that places the edge. Everything else is colour.
    body_frame : array (3, rows, columns)
        Each pixel's point in the body's own frame, mm, so that the core lies where the core is.
    pixel_size : float
        mm
    plate : tuple
        The plate's colour.
    look : Realism
    index : int
        The slice's number; with the seed it fixes the random numbers.
    thing : tuple, optional
        A reference object that lies on the plate.
    """
    rng = np.random.default_rng([look.seed, index])
    depth = distance_transform_edt(covered > 0.5) * pixel_size
    painter: Painter = PAINTERS[look.specimen]
    body = painter(body_frame, depth, rng, look.texture, look.rim)
    grain = relief(rng, covered.shape, 1.2) * 1.2 + relief(rng, covered.shape, 40) * 1.5
    ground = np.asarray(look.plate or plate)[:, None, None] + grain
    if look.kitchen is not None:
        ground = look.kitchen.plate(ground, covered, pixel_size, look.seed, index)
        body = look.kitchen.flesh(body, depth, pixel_size, look.seed, index)
    scene = covered * body + (1 - covered) * ground
    if thing is not None:
        scene = thing[0] * thing[1] + (1 - thing[0]) * scene
    blur = look.blur if look.kitchen is None else look.kitchen.blur(look.blur, index)
    scene = np.stack([gaussian_filter(channel, blur, mode="nearest") for channel in scene])
    scene = scene * _lamp(covered.shape, look)
    shot = look.noise * np.sqrt(0.35 + 0.65 * np.clip(scene, 0, 255) / 255)
    scene = scene + shot * rng.normal(size=scene.shape)
    return np.clip(np.moveaxis(scene, 0, -1), 0, 255)


def _lamp(shape: tuple[int, ...], look: Realism) -> FloatArray:
    """Return the light's relative strength per pixel: a slope and darker corners, fixed for a stack."""
    angle = np.random.default_rng([look.seed, 999]).uniform(0, 2 * np.pi)
    y, x = np.meshgrid(*(np.linspace(-1, 1, n) for n in shape), indexing="ij")
    slope = (x * np.cos(angle) + y * np.sin(angle)) / (2 * np.sqrt(2)) + 0.5
    light: FloatArray = 1 - look.light * (0.6 * slope + 0.2 * (x**2 + y**2))
    return light
