r"""The scanner's grid: which slices are taken, where each picture's pixels lie, how slabs see the body.

::

       n ^   /______/  P_2 = P_0 + z_2·d         tilt: the pictures' origins move by tan(tilt) along the
         |  /______/   P_1                       columns' direction as z grows; the body does not, so in
         | /______/    P_0                       the pictures it moves the other way

A slab's grey is the mean over its thickness (partial volume), by Gauss–Legendre points across it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.contour_stack import Loop
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.coverage import coverage
from stackloft.testing.phantoms.phantom import Phantom

OUTLINE = 1500
"""Points on each outline; the polygon's area is short by about 7/OUTLINE²."""
MOST_PIXELS = 4096
"""A side."""


@dataclass(frozen=True, slots=True, eq=False)
class ScanGrid:
    """Slices and pixels of a scan in the scanner's own frame (x along rows, y along columns, z normal)."""

    positions: FloatArray
    """(m) mm along the slices' normal"""
    thickness: float
    """mm"""
    origin: FloatArray
    """(2) mm: (x, y) of pixel (0, 0)'s centre on the slice at z = 0"""
    shape: tuple[int, int]
    """(rows, columns)"""
    spacing: tuple[float, float]
    """(row, column) mm"""
    shear: float
    """tan(tilt): mm by which a picture's origin moves in y for each mm of z"""

    def corner(self, z: float) -> FloatArray:
        """Return (x, y, z) mm of pixel (0, 0) on the slice at `z`."""
        return np.array([self.origin[0], self.origin[1] + self.shear * z, z])

    def polygons(self, loops: tuple[Loop, ...], z: float) -> list[FloatArray]:
        """Return loops in pixels of the slice at `z`, as `coverage` takes them."""
        row, column = self.spacing
        corner = self.corner(z)[:2]
        return [(loop.points - corner) / np.array([column, row]) + 0.5 for loop in loops]

    def slab(self, phantom: Phantom, z: float, points: int) -> FloatArray:
        """Return how much of every pixel the body fills in the slab at `z`, (rows, columns) 0 to 1."""
        nodes, weights = np.polynomial.legendre.leggauss(points)
        low, high = phantom.extent()
        covered = np.zeros(self.shape)
        for node, weight in zip(nodes, weights, strict=True):
            height = z + 0.5 * self.thickness * float(node)
            if low < height < high:
                loops = phantom.section(height, OUTLINE)
                covered += 0.5 * float(weight) * coverage(self.polygons(loops, z), self.shape)
        return covered


def scan_grid(
    phantom: Phantom,
    positions: FloatArray,
    thickness: float,
    spacing: tuple[float, float],
    margin: float,
    tilt: float,
) -> ScanGrid:
    """Return the smallest grid that holds the body on every slice with `margin` mm around it.

    Raises
    ------
    UsageError
        A side of fewer than 8 or more than 4096 pixels, or a tilt of more than 45°.

    Examples
    --------
    >>> from stackloft.testing import phantoms
    >>> ball = phantoms.make("ellipsoid", a=10, b=10, c=10)
    >>> scan_grid(ball, np.array([-5.0, 5.0]), 10.0, (1.0, 0.5), 2.0, 0.0).shape
    (25, 49)
    """
    if not abs(tilt) <= 45:
        raise UsageError("too steep", where="tilt", found=f"{tilt:g}°", expected="-45 to 45°")
    shear = float(np.tan(np.radians(tilt)))
    outlines = []
    low, high = phantom.extent()
    for z in np.linspace(low + 1e-3 * (high - low), high - 1e-3 * (high - low), 25):
        points = np.concatenate([loop.points for loop in phantom.section(float(z), 100)])
        outlines.append(points - np.array([0.0, shear * float(z)]))
    every = np.concatenate(outlines)
    least, most = every.min(axis=0) - margin, every.max(axis=0) + margin
    sides = np.ceil((most - least) / np.array(spacing)[::-1]).astype(int) + 1
    if sides.min() < 8 or sides.max() > MOST_PIXELS:
        raise UsageError(
            "pictures of an impossible size", where="pixel_size", found=f"{sides[0]} × {sides[1]} pixels",
            expected=f"8 to {MOST_PIXELS} a side", fix="change pixel_size or margin",
        )  # fmt: skip
    return ScanGrid(positions, thickness, least, (int(sides[1]), int(sides[0])), spacing, shear)
