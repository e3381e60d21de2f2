"""The grey levels of a window of a picture: filtered, under even light, the body above its background."""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np

from stackloft.model.reused_memory import empty
from stackloft.model.slice_stack import Picture
from stackloft_plugins.segmenters.flat_field import AT_ONCE, Light, Window
from stackloft_plugins.segmenters.grey import FINE, Levels, filtered


def window_levels(
    picture: Picture, window: Window, channel: str, sign: float, light: Light | None
) -> tuple[Levels, float]:
    """Return the window's levels, and how many grey levels of the picture are one unit of theirs.

    Parameters
    ----------
    picture : array (rows, columns) or (rows, columns, 3)
    window : rows and columns
    channel : str
        A key of `CHANNELS`.
    sign : float
        1 for a body lighter than its background, else -1.
    light : Light or None

    Examples
    --------
    >>> window = (slice(0, 4), slice(0, 5))
    >>> levels, unit = window_levels(np.full((4, 5), 100, np.uint8), window, "luminance", -1.0, None)
    >>> levels.dtype, float(levels[0, 0]) * unit
    (dtype('int16'), -100.0)
    """
    part = picture[window]
    fine = FINE if part.dtype == np.uint8 and part.ndim == 2 else 1
    levels = empty(part.shape[:2], np.float32 if fine == 1 else np.int16)
    factor, depth = levels.dtype.type(sign * fine), cv2.CV_32F if fine == 1 else cv2.CV_16S
    for some, own in _even(len(levels)) if light is None else light.strips(window):
        before = min(some.start, 1)
        plain = filtered(part[some.start - before : some.stop + 1], channel)
        plain = plain[before : before + some.stop - some.start]
        if own is None:
            np.multiply(plain, factor, out=levels[some])
        else:
            cv2.divide(np.ascontiguousarray(plain), own, levels[some], scale=sign * fine, dtype=depth)
    return levels, 1.0 / fine


def _even(rows: int) -> Iterator[tuple[slice, None]]:
    """Yield some rows at once, as `Light.strips` does: what is in between stays in the processor's cache."""
    for top in range(0, rows, AT_ONCE):
        yield slice(top, min(top + AT_ONCE, rows)), None
