"""A slice as those see it who look at its pixels and those of the slices beside it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from stackloft.compiled.coverage import Shown, shown_all
from stackloft.model.segmentation import SectionField
from stackloft_plugins.integrators.morphology import Mask


class SeenSlice:
    """A slice's field, where it lies, and where it is body."""

    def __init__(self, section: SectionField) -> None:
        self.section = section
        self.shown: Shown | None = None
        """The same for the compiled kernels, after `show_all`; None where they cannot read it."""

    @cached_property
    def body(self) -> Mask:
        """1 where the body is, on the section's crop."""
        return self.section.above().view(np.uint8)

    def mask(self, window: tuple[int, int, int, int]) -> Mask:
        """Return 1 where the body is, on rows [0]..[2] and columns [1]..[3]."""
        if window == self.window:
            return self.body
        top, left, bottom, right = window
        mask = np.zeros((bottom - top, right - left), np.uint8)
        row, column = self.section.offset[0] - top, self.section.offset[1] - left
        part = self.body[
            max(-row, 0) : max(bottom - top - row, 0), max(-column, 0) : max(right - left - column, 0)
        ]
        row, column = max(row, 0), max(column, 0)
        mask[row : row + part.shape[0], column : column + part.shape[1]] = part
        return mask

    @property
    def window(self) -> tuple[int, int, int, int]:
        """Top, left, bottom, right."""
        row, column = self.section.offset
        rows, columns = self.section.values.shape
        return row, column, row + rows, column + columns


def show_all(slices: Sequence[SeenSlice]) -> None:
    """Make slices ready for the compiled kernels, which need one level for all pixels."""
    new = [seen for seen in slices if seen.shown is None and seen.section.local_levels is None]
    fields = [(own.values, own.level, own.offset, own.noise) for own in (seen.section for seen in new)]
    for seen, shown in zip(new, shown_all(fields) or (), strict=False):
        seen.shown = shown
