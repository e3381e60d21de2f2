r"""Partial volume: grey levels as the fraction of a pixel or slab that the body fills.

::

    coverage                       1    counted: wholly inside, in the slices before and after too
      1 |#####.                  0..1   (grey − background) / (body − background), summed
        |      \                   0    not counted: far outside
      0 |       `------
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stackloft.compiled.coverage import Covered
from stackloft.contracts.options import option
from stackloft.contracts.sink import Sink
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.measurement import Integral
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SectionKind
from stackloft.sectioning.ahead import HELD, TOGETHER
from stackloft.sectioning.clean_field import cleaned
from stackloft.sectioning.slabs import slab_sum_at
from stackloft.sectioning.streaming import streamed
from stackloft_plugins.integrators.edge_zone import Neighboured, edge_zones, innermost
from stackloft_plugins.integrators.ring_levels import ring_levels, rings_of
from stackloft_plugins.integrators.seen_slice import SeenSlice

_NAN = float("nan")
_TELLING = 100
"""Slices of a scan, evenly from first to last, that tell the two levels of all: more are no surer."""
MOST_EXCESS = 0.02
"""Part of the volume by which an edge zone's pixels may be more than full: a skin so bright is no edge."""


@dataclass(frozen=True)
class PartialVolume:
    """Sum of coverage: unbiased for a body of one grey before a background of another, at any voxel size.

    Assumes that grey is proportional to the filled fraction of a pixel (and of a slab, for scans) and that
    blur keeps within ``zone`` pixels of the edge; the two levels are those of rings on either side of that
    zone, per slice for photographs, over some hundred slices for scans. No threshold enters, so that slabs
    that are filled to less than a half count too, those beyond the outermost contours among them. Errs with a
    skin of another grey than the flesh below it: by its thickness times the relative difference; refuses one
    so much brighter that pixels inside would be more than full by 2 % of the volume. Gives no area.
    Across photographs (faces) it errs as Cavalieri's rule does. Of a label map it is the sum of voxels.
    """

    zone: int = option(2, "how far from the edge pixels may be partly filled", unit="px", ge=1, le=20)

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Segmentation,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

    def sink(self) -> Sink:
        """Return what takes the slices one by one and ends with the Integral."""
        return _CoverageSink(self.zone)

    def integrate(self, product: Segmentation) -> Integral:
        """Return the volume, mm³; the area is None.

        Raises
        ------
        InputError
            No body; a body so thin that no pixel lies wholly inside; one whose skin is far brighter.
        """
        return streamed(product, self, Integral)


@dataclass(frozen=True, slots=True)
class _SliceSums:
    """What one slice adds, before the grey levels are known."""

    inside: int
    """px wholly inside"""
    edge: int
    """px in the edge zone"""
    grey: float
    """Sum of the edge zone's field."""
    full: int
    """px of the edge zone inside the body, on the slices before and after too: at most filled"""
    full_grey: float
    """Sum of their field."""
    body: float
    """Field of the ring inside; NaN when there is none."""
    background: float
    near: float
    """Field of what is at least one pixel inside, for bodies so thin that there is no ring."""


class _CoverageSink:
    """Sums slices, some at a time, when the ones after them are there."""

    looks_at_pictures = False

    def __init__(self, zone: int) -> None:
        self._zone = zone

    def begin(self, segmentation: Segmentation) -> None:
        self._segmentation = segmentation
        stack = segmentation.stack
        self._slab = stack.kind is SectionKind.SLAB
        self._row: list[SeenSlice | None] = [None]
        self._sums: list[_SliceSums] = []
        slices = len(segmentation.before) + len(segmentation) + len(segmentation.after)
        self._telling = max(1, slices // _TELLING) if self._slab else 1
        for beyond in segmentation.before:
            self._take(self._seen(beyond.field()))

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:  # noqa: ARG002
        self._take(self._seen(section_field))

    def end(self) -> Integral:
        segmentation, stack = self._segmentation, self._segmentation.stack
        for beyond in segmentation.after:
            self._take(self._seen(beyond.field()))
        self._row.append(None)
        self._sum_up()
        first, last = (
            [(x.position, x.pixel_area) for x in some] for some in (segmentation.before, segmentation.after)
        )
        own = zip(stack.positions, stack.pixel_spacing.prod(axis=1), strict=True)
        positions, pixels = np.array([*first, *own, *last]).T
        volume, bias = slab_sum_at(self._covered() * pixels, positions, stack)
        return Integral(volume, None, volume_bias=bias)

    def _seen(self, section: SectionField) -> SeenSlice:
        return SeenSlice(section if self._segmentation.binary else cleaned(section, labels=False))

    def _take(self, seen: SeenSlice) -> None:
        """Take the next slice; those before it are summed up when there are enough of them."""
        self._row.append(seen)
        held = sum(one.section.values.nbytes for one in self._row if one is not None)
        if len(self._row) == TOGETHER + 2 or held > HELD:
            self._sum_up()

    def _sum_up(self) -> None:
        """Sum up all slices but the last, whose next one is not there, and the first, which has been."""
        row, self._row = self._row, self._row[-2:]
        threes = [
            (before, current, after)
            for before, current, after in zip(row, row[1:], row[2:], strict=False)
            if current is not None
        ]
        if self._segmentation.binary:
            self._sums += [_counted(current) for _, current, _ in threes]
            return
        slices = []
        for number, (before, current, after) in enumerate(threes, len(self._sums)):
            rings = rings_of(current.section) if number % self._telling == 0 else None
            beside = (before, after) if self._slab else (current, current)
            slices.append(Neighboured(current, beside, rings))
        self._sums += [
            _summed(one, own) for one, own in zip(slices, edge_zones(slices, self._zone), strict=True)
        ]

    def _covered(self) -> FloatArray:
        """Return each slice's covered area in pixels."""
        if self._segmentation.binary:
            return np.array([one.inside for one in self._sums], dtype=np.float64)
        levels = np.array([(x.background, x.body) for x in self._sums])
        if np.isnan(levels[:, 1]).all():
            levels[:, 1] = [x.near for x in self._sums]
        if np.isnan(levels).all(axis=0).any():
            raise InputError(
                "no pixel lies wholly inside the body, or none wholly outside: no grey level is known",
                fix="lower the option zone, or use --method voxel",
            )
        whole = np.nanmedian(levels, axis=0)
        levels = (
            np.broadcast_to(whole, levels.shape) if self._slab else np.where(np.isnan(levels), whole, levels)
        )
        inside, edge, grey, full, full_grey = np.array(
            [(x.inside, x.edge, x.grey, x.full, x.full_grey) for x in self._sums]
        ).T
        background, step = levels[:, 0], levels[:, 1] - levels[:, 0]
        covered = inside + (grey - edge * background) / step
        _check_edge((full_grey - full * background) / step, full, float(covered.sum()))
        return np.asarray(covered)


def _counted(current: SeenSlice) -> _SliceSums:
    """Return what one slice of a label map adds: its voxels."""
    return _SliceSums(int(np.count_nonzero(current.body)), 0, 0.0, 0, 0.0, _NAN, _NAN, _NAN)


def _check_edge(filled: FloatArray, pixels: FloatArray, volume: float) -> None:
    """Raise when pixels of the edge zone would be more than full: the volume is too high by that at least."""
    excess = float((filled - pixels).sum())
    if excess > MOST_EXCESS * volume:
        raise InputError(
            "the body is brighter at its edge than inside: grey is no measure of how full a pixel is",
            where="partial-volume",
            found=f"{filled.sum() / pixels.sum():.2f} of the inner grey level in the edge zone, "
            f"which makes the volume at least {100.0 * excess / volume:.0f} % too high",
            fix="use --method voxel, cavalieri or loft",
        )


def _summed(one: Neighboured, found: Covered) -> _SliceSums:
    """Return what one slice adds; the grey levels are NaN where its rings were not asked for."""
    body = background = near = _NAN
    if found.rings is not None:
        body, background = ring_levels(*found.rings)
        near = innermost(one) if np.isnan(body) else body
    return _SliceSums(
        found.inside, found.edge, found.grey, found.full, found.full_grey, body, background, near
    )
