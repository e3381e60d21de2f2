"""One body's field: the scan's own around it, with every other body brought to the background's side."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import BoolArray
from stackloft.model.scale import scale_of_slices
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Hints, Picture, SliceStack, prefetch
from stackloft.sectioning.kept_slices import KeptSlices
from stackloft.sectioning.linked_pieces import LinkedPieces
from stackloft.sectioning.slice_pieces import Corner
from stackloft.sectioning.voids import VoidFinder

MARGIN = 12
"""Pixels kept around a body, for what looks at the background beside it."""

MOSTLY = 0.9
"""Part of a void's rim that is a body's, when the void is."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyField:
    """A `field_of` that shows one body, and of the others nothing."""

    whole: Segmentation
    links: LinkedPieces
    own: BoolArray
    voids: VoidFinder
    first: int
    """Number of the body's first slice in the whole scan."""
    outlines: Mapping[int, NDArray[np.int32]]
    """As `SectionField` has them, by number in the whole scan, where they are known."""
    kept: KeptSlices | None = None
    """Where pixels look alone (`Segmentation.pointwise`): what is kept of the scan's slices."""
    _boxes: dict[int, Box | None] = field(default_factory=dict)
    """By number in the whole scan, of those asked for before: neighbours ask for the same ones."""

    def __call__(self, number: int, picture: Picture) -> SectionField:
        """Return the field of the body's slice `number`; an empty picture stands for what is kept of it."""
        index = number + self.first
        if picture.size or self.kept is None:
            return self._shown(index, self.whole.field_of(index, picture))
        part, (rows, columns) = self.kept.part(index)
        return self._shown(
            index, replace(self.whole.field_of(index, part), offset=(rows.start, columns.start))
        )

    def _shown(self, index: int, section: SectionField) -> SectionField:
        """Return a slice's field with the body alone."""
        own = self.own[self.links.of_slice(index)]
        closed, closed_corner = self.voids.closed(index) if self.whole.fill_voids else (_NONE, (0, 0))
        if len(own) == 1 and own[0] and not closed.size and not self.whole.labels:
            part = _cropped(section, _window(self._box(index), section))
            return replace(part, outline=self.outlines.get(index))
        pieces, corner = self.links.pieces(index)
        shown = np.concatenate([[False], own])[pieces]
        window = _window(self._box(index), section)
        mine = placed(shown, corner, window)
        if self.whole.labels:
            return SectionField(mine.astype(np.float64), 0.5, _corner(window), 0.5)
        part = _cropped(section, window)
        level = part.level if part.local_levels is None else part.local_levels
        field = part.relative()
        field = np.where(mine, field, -np.abs(field))
        if closed.size:
            others = placed((pieces > 0) & ~shown, corner, window)
            within = enclosed(placed(closed, closed_corner, window), mine, others)
            field = np.where(within, np.maximum(np.abs(field), np.finfo(float).tiny), field)
        return replace(part, values=field + level, noise=None)

    def shows(self, index: int) -> bool:
        """Return whether the body is on slice `index` of the whole scan."""
        return bool(self.own[self.links.of_slice(index)].any())

    def _box(self, index: int) -> Box | None:
        """Return the box around the body on a slice and on those beside it, which slabs share voxels with."""
        near = range(max(0, index - 1), min(len(self.links), index + 2))
        boxes = [box for box in map(self._own_box, near) if box is not None]
        return None if not boxes else _joined(boxes)

    def _own_box(self, index: int) -> Box | None:
        if index not in self._boxes:
            self._boxes[index] = self._box_of(index)
        return self._boxes[index]

    def _box_of(self, index: int) -> Box | None:
        own = self.own[self.links.of_slice(index)]
        if not own.any():
            return None
        (row, column), (rows, columns) = self.links.shape(index)
        if not own.all():
            shown = np.concatenate([[False], own])[self.links.pieces(index)[0]]
            left, top, columns, rows = cv2.boundingRect(shown.view(np.uint8))
            row, column = row + top, column + left
        return row, column, row + rows, column + columns


Box = tuple[int, int, int, int]
"""Top, left, bottom, right."""


def _joined(boxes: list[Box]) -> Box:
    top, left, bottom, right = zip(*boxes, strict=True)
    return min(top), min(left), max(bottom), max(right)


_NONE: BoolArray = np.zeros((0, 0), dtype=np.bool_)


def _cropped(section: SectionField, window: tuple[slice, slice]) -> SectionField:
    row, column = section.offset
    inner = (slice(window[0].start - row, window[0].stop - row),
             slice(window[1].start - column, window[1].stop - column))  # fmt: skip
    local = None if section.local_levels is None else section.local_levels[inner]
    return replace(section, values=section.values[inner], offset=_corner(window), local_levels=local)


def placed(crop: BoolArray, corner: Corner, window: tuple[slice, slice]) -> BoolArray:
    """Return a crop of a slice on another window of it; False where the crop does not reach."""
    row, column = corner[0] - window[0].start, corner[1] - window[1].start
    shape = (window[0].stop - window[0].start, window[1].stop - window[1].start)
    placed = np.zeros(shape, dtype=np.bool_)
    part = crop[max(-row, 0) : max(shape[0] - row, 0), max(-column, 0) : max(shape[1] - column, 0)]
    row, column = max(row, 0), max(column, 0)
    placed[row : row + part.shape[0], column : column + part.shape[1]] = part
    return placed


def enclosed(voids: BoolArray, mine: BoolArray, others: BoolArray) -> BoolArray:
    """Return the voids that this body encloses, among those of all bodies.

    A gap between bodies that touch is closed in by them together, and is part of none.

    Examples
    --------
    >>> void, ring = np.zeros((2, 5, 5), dtype=bool)
    >>> void[2, 2], ring[1:4, 1:4] = True, True
    >>> left = ring & (np.arange(5) < 2)
    >>> bool(enclosed(void, ring & ~void, ring & ~ring).any()), bool(enclosed(void, left, ring & ~left).any())
    (True, False)
    """
    _, pieces = cv2.connectedComponents(voids.astype(np.uint8), connectivity=8)
    count = int(pieces.max()) + 1
    beside = cv2.dilate(np.where(voids, pieces, 0).astype(np.float32), np.ones((3, 3))).astype(np.int64)
    own, foreign = (np.bincount(beside[body & ~voids], minlength=count) for body in (mine, others))
    whose = own > MOSTLY * (own + foreign)
    whose[0] = False
    return np.asarray(whose[pieces] & voids)


def _window(box: Box | None, section: SectionField) -> tuple[slice, slice]:
    """Return rows and columns of a box and a margin, within the section's own crop; all, without a box."""
    window = []
    for axis in (0, 1):
        low, high = section.offset[axis], section.offset[axis] + section.values.shape[axis]
        start, stop = (low, high) if box is None else (box[axis], box[axis + 2])
        window.append(slice(max(low, start - MARGIN), min(high, stop + MARGIN)))
    return window[0], window[1]


def _corner(window: tuple[slice, slice]) -> tuple[int, int]:
    return int(window[0].start), int(window[1].start)


def cut_stack(stack: SliceStack, first: int, stop: int) -> SliceStack:
    """Return the slices from `first` up to `stop`, still at their places."""
    kept = slice(first, stop)
    return replace(
        stack,
        decode=_Shifted(stack.decode, first),
        names=stack.names[kept],
        positions=stack.positions[kept],
        pixel_spacing=stack.pixel_spacing[kept],
        thickness=None if stack.thickness is None else stack.thickness[kept],
        scale_uncertainty=scale_of_slices(stack.scale_uncertainty, np.arange(first, stop)),
        hints=_shifted_hints(stack.hints, first, stop),
    )


@dataclass(frozen=True, slots=True)
class _Shifted:
    """The decoder of a part of a stack."""

    decode: Callable[[int], Picture]
    first: int

    def __call__(self, number: int) -> Picture:
        return self.decode(number + self.first)

    def prefetch(self, numbers: Sequence[int]) -> None:
        prefetch(self.decode, [number + self.first for number in numbers])


def _shifted_hints(hints: Hints, first: int, stop: int) -> Hints:
    slices: Mapping[int, Mapping[str, object]] = {
        number - first: said for number, said in hints.slices.items() if first < number <= stop
    }
    return replace(hints, slices=slices)
