"""What is known of a reference object in a picture."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

EDGE_PLACE = 0.04
"""Pixels of the picture or copy it is measured on: standard uncertainty of where the half-way level lies, the
same all around."""


@dataclass(frozen=True, slots=True, eq=False)
class PixelSize:
    """An object's size in pixels."""

    size: float
    """Diameter, side or length."""
    uncertainty: float
    """Standard uncertainty of the size, pixels, from how the points scatter."""
    misfit: float
    """Standard deviation of the points from the circle or the lines, relative to the size."""
    oblique: float
    """How unlike its two diameters, or its two sides, are, relative; 0 for a ruler."""
    grain: int = 1
    """Pixels that a pixel of the copy is long on which it was measured."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """A reference object in one picture."""

    size: PixelSize
    centre: tuple[float, float]
    """(column, row), pixels"""
    corner: tuple[int, int]
    """(row, column) of the hidden window's first pixel."""
    hidden: NDArray[np.bool_]
    """True where the object and its shadow are, within the window."""

    def enlarged(self, factor: int) -> Found:
        """Return the same object in the picture of which this one is a copy, `factor` times smaller."""
        own = self.size
        size = replace(
            own, size=factor * own.size, uncertainty=factor * own.uncertainty, grain=factor * own.grain
        )
        column, row = (factor * (at + 0.5) - 0.5 for at in self.centre)
        corner = (factor * self.corner[0], factor * self.corner[1])
        hidden = self.hidden.repeat(factor, axis=0).repeat(factor, axis=1)
        return Found(size, (column, row), corner, hidden)


@dataclass(frozen=True, slots=True)
class Missing:
    """Why no reference object was found."""

    reason: str
    cut_off: bool = False
    """True when what may be it touches the picture's border."""
