"""Sections as closed loops in millimetres."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import FloatArray, IntArray, frozen_floats, frozen_ints
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.scale import ScaleUncertainty
from stackloft.model.slice_stack import Hints, SectionKind


@dataclass(frozen=True, slots=True, eq=False)
class Loop:
    """One closed curve of a section: vertices in order, the last joined to the first."""

    points: FloatArray
    """(k, 2) mm, k ≥ 3, no repeated end point."""
    corners: IntArray = field(default_factory=lambda: frozen_ints([]))
    """(c) indices into `points` where the boundary really has a corner."""
    hole: bool = False
    """True when the loop bounds a hole of the section."""

    @property
    def signed_area(self) -> float:
        """Shoelace area of the polygon, mm²; positive when counter-clockwise in (x, y)."""
        return polygon_area(self.points)


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """The loops at one position."""

    z: float
    """mm along the axis"""
    loops: tuple[Loop, ...]
    name: str
    """File or slice label, for messages."""


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class ContourStack:
    """Sections in order along the axis."""

    sections: tuple[Section, ...]
    kind: SectionKind = SectionKind.FACE
    exact: bool = True
    """True when the points lie on the boundary itself; False when they were traced on pixels."""
    resolution: float = 0.0
    """Pixel size in mm the loops were traced on; 0 for exact loops."""
    thickness: float | None = None
    """A slab's own thickness, mm."""
    seen_beyond: tuple[float, float] = (0.0, 0.0)
    """How far beyond the first and last section the body still showed, too little for a contour, mm."""
    affine: FloatArray = field(default_factory=lambda: frozen_floats(np.eye(4)))
    """(4, 4) from stack millimetres to bench millimetres."""
    scale_uncertainty: ScaleUncertainty | None = None
    """How well the scale in the section planes is known; None: nothing is known of that."""
    hints: Hints = field(default_factory=Hints)
    notices: tuple[Notice, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_contour_stack(self)

    def __len__(self) -> int:
        return len(self.sections)

    @property
    def positions(self) -> FloatArray:
        """(m) mm, strictly increasing."""
        return np.array([section.z for section in self.sections])


def check_contour_stack(stack: ContourStack) -> None:
    """Raise InputError when positions do not increase or a loop is no closed curve."""
    z = stack.positions
    if not np.isfinite(z).all():
        raise InputError("section positions must be finite")
    for before, after in zip(stack.sections, stack.sections[1:], strict=False):
        if not after.z > before.z:
            raise InputError(
                "section positions must increase",
                where=after.name,
                found=f"{after.z:g} mm after {before.z:g} mm",
            )
    for section in stack.sections:
        for loop in section.loops:
            _check_loop(loop, section.name)


def _check_loop(loop: Loop, name: str) -> None:
    if loop.points.ndim != 2 or loop.points.shape[1] != 2 or len(loop.points) < 3:
        raise InputError("a loop needs at least 3 points (x, y)", where=name, found=str(loop.points.shape))
    if not np.isfinite(loop.points).all():
        raise InputError("a loop has points that are not finite", where=name)
