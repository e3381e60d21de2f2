"""One body's field: the scan's own around it, with every other body brought to the background's side."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import cv2
import numpy as np

from stackloft.model.arrays import BoolArray
from stackloft.model.scale import scale_of_slices
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Hints, Picture, SliceStack
from stackloft.sectioning.linked_pieces import LinkedPieces
from stackloft.sectioning.voids import VoidFinder

MARGIN = 12
"""Pixels kept around a body, for what looks at the background beside it."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyField:
    """A `field_of` that shows one body, and of the others nothing."""

    whole: Segmentation
    links: LinkedPieces
    own: BoolArray
    voids: VoidFinder
    first: int
    """Number of the body's first slice in the whole scan."""

    def __call__(self, number: int, picture: Picture) -> SectionField:
        """Return the field of the body's slice `number`."""
        index = number + self.first
        section = self.whole.field_of(index, picture)
        pieces = self.links.pieces(index)
        mine = np.concatenate([[False], self.own[self.links.of_slice(index)]])[pieces]
        window = _window(mine, section)
        row, column = section.offset
        inner = (slice(window[0].start - row, window[0].stop - row),
                 slice(window[1].start - column, window[1].stop - column))  # fmt: skip
        if self.whole.labels:
            return SectionField(mine[window].astype(np.float64), 0.5, _corner(window), 0.5)
        local = None if section.local_levels is None else section.local_levels[inner]
        level = section.level if local is None else local
        field = section.values[inner] - level
        field = np.where(mine[window], field, -np.abs(field))
        if self.whole.fill_voids:
            closed = touching(self.voids.closed(index)[window], mine[window])
            field = np.where(closed, np.maximum(np.abs(field), np.finfo(float).tiny), field)
        return replace(section, values=field + level, offset=_corner(window), local_levels=local)


def touching(voids: BoolArray, mine: BoolArray) -> BoolArray:
    """Return the voids that this body encloses, among those of all bodies."""
    _, pieces = cv2.connectedComponents(voids.astype(np.uint8), connectivity=8)
    beside = cv2.dilate(mine.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    return np.asarray(np.isin(pieces, np.unique(pieces[voids & beside])) & voids)


def _window(mine: BoolArray, section: SectionField) -> tuple[slice, slice]:
    """Return rows and columns of the body and a margin, within the section's own crop."""
    window = []
    for axis in (0, 1):
        used = np.flatnonzero(mine.any(axis=1 - axis))
        low, high = section.offset[axis], section.offset[axis] + section.values.shape[axis]
        start, stop = (int(used[0]), int(used[-1])) if len(used) else (low, high - 1)
        window.append(slice(max(low, start - MARGIN), min(high, stop + 1 + MARGIN)))
    return window[0], window[1]


def _corner(window: tuple[slice, slice]) -> tuple[int, int]:
    return int(window[0].start), int(window[1].start)


def cut_stack(stack: SliceStack, first: int, stop: int) -> SliceStack:
    """Return the slices from `first` up to `stop`, still at their places."""
    kept = slice(first, stop)
    return replace(
        stack,
        decode=_shifted(stack.decode, first),
        names=stack.names[kept],
        positions=stack.positions[kept],
        pixel_spacing=stack.pixel_spacing[kept],
        thickness=None if stack.thickness is None else stack.thickness[kept],
        scale_uncertainty=scale_of_slices(stack.scale_uncertainty, np.arange(first, stop)),
        hints=_shifted_hints(stack.hints, first, stop),
    )


def _shifted(decode: Callable[[int], Picture], first: int) -> Callable[[int], Picture]:
    return lambda number: decode(number + first)


def _shifted_hints(hints: Hints, first: int, stop: int) -> Hints:
    slices: Mapping[int, Mapping[str, object]] = {
        number - first: said for number, said in hints.slices.items() if first < number <= stop
    }
    return replace(hints, slices=slices)
