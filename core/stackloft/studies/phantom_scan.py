r"""A phantom scanned in memory: grey levels of exact coverage, their boundary at half-way.

::

    face   z_k  ----------         coverage on one plane: a photograph's cut
    slab   z_k  |========|         mean over the slab, by pairs of Gauss-Legendre points

No file, lens or threshold stands between body and method, so that what is left is the method's own error.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, read_only
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Hints, SectionKind, SliceStack
from stackloft.testing.phantoms import Phantom
from stackloft.testing.phantoms.coverage import coverage

OUTLINE = 800
"""Points on each outline; the polygon's area is short by about 7/OUTLINE², 1e-5."""
MARGIN = 8
"""Pixels around the body."""
BODY = 200.0
"""Grey level of the body; 0 outside."""
FEWEST = 16
"""Pixels that a section must cover to be traced; a person leaves out slices on which nothing is seen."""


class Subject:
    """A phantom whose sections are cut once, however many scans look at them."""

    def __init__(self, phantom: Phantom, told: Callable[[FloatArray], Hints]) -> None:
        self.phantom = phantom
        self.told = told
        """What a person tells who sees sections at these positions, mm."""
        self._cut: dict[float, tuple[Loop, ...]] = {}

    def section(self, z: float) -> tuple[Loop, ...]:
        """Return the exact loops at `z`, `OUTLINE` points on each."""
        key = round(z, 9)
        if key not in self._cut:
            self._cut[key] = self.phantom.section(z, OUTLINE)
        return self._cut[key]

    def contours(self, sections: int) -> ContourStack:
        """Return exact sections at mid-thickness, with what is told."""
        z = self.phantom.positions(sections, "mid")
        cuts = (Section(float(at), self.section(float(at)), f"section_{k + 1:02d}") for k, at in enumerate(z))
        return ContourStack(tuple(cuts), hints=self.told(z))


@dataclass(frozen=True, slots=True)
class Scan:
    """How a subject is scanned: equal slices over its whole height, each at its own middle."""

    slices: int
    pixel: float
    """mm"""
    slabs: int = 0
    """Slabs over the whole height with two planes each, a multiple of `slices`; 0: faces, one plane each."""
    phase: tuple[float, float] = (0.0, 0.0)
    """Where the pixel grid lies, fractions of a pixel."""

    def of(self, subject: Subject) -> Segmentation:
        """Return the grey slices with the body's level.

        Examples
        --------
        >>> from stackloft.testing import phantoms
        >>> ball = phantoms.make("ellipsoid", a=10, b=10, c=10)
        >>> scan = Scan(slices=20, pixel=1.0, slabs=40).of(Subject(ball, lambda positions: Hints()))
        >>> covered = sum(float(scan.stack.decode(k).sum()) for k in range(20)) / BODY
        >>> abs(covered / ball.volume - 1) < 1e-4
        True
        """
        phantom, planes = subject.phantom, self._planes(subject.phantom)
        each = len(planes) // self.slices
        origin, shape = self._grid(subject, planes)
        covered = [
            coverage([(loop.points - origin) / self.pixel for loop in subject.section(float(z))], shape)
            for z in planes
        ]
        pictures = [
            read_only(BODY * np.mean(covered[k * each : (k + 1) * each], axis=0)) for k in range(self.slices)
        ]
        z = phantom.positions(self.slices, "mid")
        stack = SliceStack(
            decode=pictures.__getitem__,
            names=tuple(f"slice_{k + 1:03d}" for k in range(self.slices)),
            shape=shape,
            positions=frozen_floats(z),
            pixel_spacing=np.full((self.slices, 2), self.pixel),
            kind=SectionKind.SLAB if self.slabs else SectionKind.FACE,
            thickness=np.full(self.slices, phantom.height / self.slices) if self.slabs else None,
            hints=subject.told(z),
        )
        return Segmentation(stack, _field)

    def _planes(self, phantom: Phantom) -> FloatArray:
        """Return the heights that are looked at, mm: the faces', or two Gauss points of every slab."""
        middles = phantom.positions(self.slabs or self.slices, "mid")
        if not self.slabs:
            return middles
        reach = 0.5 * phantom.height / self.slabs / math.sqrt(3.0)
        return np.column_stack([middles - reach, middles + reach]).ravel()

    def _grid(self, subject: Subject, planes: FloatArray) -> tuple[FloatArray, tuple[int, int]]:
        """Return pixel (0, 0)'s corner, mm, and (rows, columns) of a grid that holds the body."""
        points = np.concatenate([loop.points for z in planes for loop in subject.section(float(z))])
        slack = MARGIN * self.pixel
        least = points.min(axis=0) - slack - np.array(self.phase) * self.pixel
        columns, rows = (math.ceil(x) + 1 for x in (points.max(axis=0) + slack - least) / self.pixel)
        return least, (rows, columns)


def visible(segmentation: Segmentation, told: Callable[[FloatArray], Hints]) -> Segmentation:
    """Return the slices from the first to the last that shows the body on at least `FEWEST` pixels."""
    stack = segmentation.stack
    seen = [k for k in range(len(stack)) if (stack.decode(k) > BODY / 2).sum() >= FEWEST]
    if not seen:
        return segmentation
    first, last = seen[0], seen[-1] + 1
    trimmed = replace(
        stack,
        decode=lambda k: stack.decode(k + first),
        names=stack.names[first:last],
        positions=stack.positions[first:last],
        pixel_spacing=stack.pixel_spacing[first:last],
        thickness=None if stack.thickness is None else stack.thickness[first:last],
        hints=told(stack.positions[first:last]),
    )
    return replace(segmentation, stack=trimmed)


def _field(_: int, picture: FloatArray) -> SectionField:
    return SectionField(picture, BODY / 2, threshold=BODY / 2)
