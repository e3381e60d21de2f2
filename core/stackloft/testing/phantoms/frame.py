"""The camera's frame: where the body's millimetres fall on the picture's pixels.

In the picture x = column·pixel and y = row·pixel, the origin being pixel (0, 0)'s centre; the picture is
seen along +z. Turning and mirroring happen in the picture and leave volume and area alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.nesting import oriented


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """One frame for all pictures of a stack."""

    matrix: FloatArray
    """(2, 2) bench to picture directions: a turn, mirrored or not."""
    origin: FloatArray
    """(2) mm: the turned bench point at pixel (0, 0)'s centre."""
    shape: tuple[int, int]
    """(rows, columns)"""
    pixel_size: float
    """mm"""

    def loops(self, loops: Sequence[Loop]) -> tuple[Loop, ...]:
        """Return the loops in the picture's millimetres, outer ones counter-clockwise again."""
        return oriented([Loop(loop.points @ self.matrix.T - self.origin, loop.corners) for loop in loops])

    def polygons(self, loops: Sequence[Loop]) -> list[FloatArray]:
        """Return the loops in pixels whose cells are [j, j+1] × [i, i+1], as `coverage` takes them."""
        return [loop.points / self.pixel_size + 0.5 for loop in self.loops(loops)]

    def bench(self) -> FloatArray:
        """Return every pixel centre's bench point, (2, rows, columns) mm."""
        y, x = np.meshgrid(*(np.arange(n) * self.pixel_size for n in self.shape), indexing="ij")
        turned = np.stack([x, y]) + self.origin[:, None, None]
        return np.tensordot(self.matrix.T, turned, axes=1)


def framed(
    sections: Sequence[Sequence[Loop]],
    pixel_size: float,
    margin: float,
    turn: float = 0.0,
    mirror: bool = False,
) -> Frame:
    """Return the smallest frame that holds all sections with `margin` mm around them.

    Parameters
    ----------
    sections : sequence of loops
        On the bench, mm.
    pixel_size, margin : float
        mm; a negative margin cuts the body off at the picture's border.
    turn : float
        Degrees by which the body is turned in the picture.
    mirror : bool
        Whether x is mirrored after the turn.

    Raises
    ------
    UsageError
        A pixel size that is not positive, or a picture of fewer than 8 or more than 20000 pixels a side.

    Examples
    --------
    >>> square = Loop(np.array([[0.0, 0], [3, 0], [3, 3], [0, 3]]))
    >>> framed([[square]], pixel_size=0.5, margin=2.0).shape
    (15, 15)
    """
    if not (np.isfinite(pixel_size) and pixel_size > 0):
        raise UsageError("must be positive", where="pixel_size", found=f"{pixel_size:g} mm")
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    matrix = np.diag([-1.0 if mirror else 1.0, 1.0]) @ np.array([[c, -s], [s, c]])
    points = np.concatenate([loop.points for loops in sections for loop in loops]) @ matrix.T
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    columns, rows = (int(np.ceil(side)) + 1 for side in (high - low) / pixel_size)
    if min(rows, columns) < 8 or max(rows, columns) > 20000:
        raise UsageError(
            "pictures of an impossible size", where="pixel_size", found=f"{columns} × {rows} pixels",
            expected="8 to 20000 a side", fix="change pixel_size or margin",
        )  # fmt: skip
    return Frame(matrix, low, (rows, columns), pixel_size)
