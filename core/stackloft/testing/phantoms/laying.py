r"""Slices laid down one by one under the camera: each a little aside and turned, with marks or without.

::

        o +----+          The marks are fixed to the block that the slices were cut from (rods cast in
          |body|   o      beside the body): they move with each slice, and tell how it was laid down.
          +----+
      o
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.frame import Frame

_GAP = 4.0  # mm between body and marks
_OUTLINE = 720


@dataclass(frozen=True, slots=True)
class Laying:
    """How slices are laid down.

    Examples
    --------
    >>> Laying(shift=3.0, turn=5.0).motions(2)[0].shape
    (3,)
    """

    shift: float = 3.0
    """mm: along x and y each at most so much, evenly spread"""
    turn: float = 5.0
    """Degrees, likewise"""
    seed: int = 0
    marks: float = 0.0
    """mm: diameter of the marks; 0: none"""

    def __post_init__(self) -> None:
        if not (self.shift >= 0 and self.turn >= 0 and self.marks >= 0):
            raise UsageError("must not be negative", where="laying", found=str(self))

    def motions(self, count: int) -> FloatArray:
        """Return each slice's shift x, y, mm, and turn, rad, (count, 3)."""
        rng = np.random.default_rng([self.seed, 77])
        widest = np.array([self.shift, self.shift, np.radians(self.turn)])
        motions: FloatArray = rng.uniform(-1, 1, (count, 3)) * widest
        return motions

    def frames(self, frames: Sequence[Frame], cuts: Sequence[Sequence[Loop]]) -> list[Frame]:
        """Return the frames of slices so laid down; each turns about its section's middle."""
        middles = [np.concatenate([loop.points for loop in loops]).mean(axis=0) for loops in cuts]
        return [
            _moved(frame, middle, motion)
            for frame, middle, motion in zip(frames, middles, self.motions(len(frames)), strict=True)
        ]

    def room(self, cuts: Sequence[Sequence[Loop]]) -> float:
        """Return the plate that marks and motion need around the body, mm."""
        points = np.concatenate([loop.points for loops in cuts for loop in loops])
        reach = 0.5 * float(np.linalg.norm(np.ptp(points, axis=0)))
        beside = 2 * _GAP + self.marks if self.marks else 0.0
        return beside + 2 * self.shift + (reach + beside) * float(np.sin(np.radians(self.turn)))

    def outlines(self, cuts: Sequence[Sequence[Loop]]) -> list[Loop]:
        """Return the marks on the bench: beside the widest section left, right and below."""
        if not self.marks:
            return []
        points = np.concatenate([loop.points for loops in cuts for loop in loops])
        low, high = points.min(axis=0), points.max(axis=0)
        away = _GAP + 0.5 * self.marks
        middle = (low + high) / 2
        centres = np.array([
            [low[0] - away, 0.7 * low[1] + 0.3 * middle[1]],
            [high[0] + away, middle[1]],
            [0.6 * low[0] + 0.4 * middle[0], high[1] + away],
        ])  # fmt: skip
        t = 2 * np.pi * np.arange(_OUTLINE) / _OUTLINE
        circle = 0.5 * self.marks * np.column_stack([np.cos(t), np.sin(t)])
        return [Loop(centre + circle) for centre in centres]


def _moved(frame: Frame, middle: FloatArray, motion: FloatArray) -> Frame:
    c, s = np.cos(motion[2]), np.sin(motion[2])
    turn = np.array([[c, -s], [s, c]])
    shift = middle + motion[:2] - turn @ middle
    return replace(frame, matrix=frame.matrix @ turn, origin=frame.origin - frame.matrix @ shift)
