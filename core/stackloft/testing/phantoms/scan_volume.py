"""A scan in memory: what each file format writes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import UsageError
from stackloft.testing.phantoms.scan_grid import ScanGrid

_EVEN = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class ScanVolume:
    """Slices of whole grey levels on a `ScanGrid`, somewhere in patient space."""

    name: str
    slices: tuple[NDArray[np.int16], ...]
    """(m) of (rows, columns), HU or labels"""
    grid: ScanGrid
    turn: FloatArray
    """(3, 3) scanner to patient directions"""
    origin: FloatArray
    """(3) mm: the scanner's origin in patient space"""
    label: bool = False
    """Whether the values are labels."""
    syntax: str = "explicit"
    multiframe: bool = False
    levels: tuple[float, float] = (-1000.0, 40.0)
    """HU of air and body."""

    def corner(self, k: int) -> FloatArray:
        """Return pixel (0, 0) of slice `k` in patient millimetres, (3)."""
        return np.asarray(self.turn @ self.grid.corner(float(self.grid.positions[k])) + self.origin)

    def pitch(self) -> float:
        """Return the one distance between neighbouring slices, mm; of one slice its thickness.

        Raises
        ------
        UsageError
            The slices are not equally spaced, so that the form cannot hold them.
        """
        gaps = np.diff(self.grid.positions)
        if not len(gaps):
            return self.grid.thickness
        if np.ptp(gaps) > _EVEN * float(gaps.max()):
            raise UsageError(
                "this form holds equally spaced slices alone",
                where="positions",
                found=f"gaps of {gaps.min():g} to {gaps.max():g} mm",
                fix="write dicom",
            )
        return float(gaps.mean())
