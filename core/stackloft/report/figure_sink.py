"""What is kept of the one slice that is shown step by step, while the stack is decoded once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stackloft.model.arrays import IntArray
from stackloft.model.errors import UsageError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, turn_matrix
from stackloft.report.thumbnails import Rgb, Window, as_rgb, resizable, resized, window_of

SIDE = 520
"""Longest side of one panel, pixels."""
BINS = 128

FLAG = "--figure-slice"


@dataclass(frozen=True, slots=True, eq=False)
class SliceFigure:
    """One slice, small, in the steps of its measurement; all of the same window."""

    number: int
    """Counted from 1."""
    name: str
    z: float
    """mm"""
    picture: Rgb
    """As photographed or scanned."""
    colour: bool
    """Whether the picture has colours."""
    grey: Rgb
    """The filtered grey levels that the boundary was sought in."""
    binary: Rgb
    """Body white."""
    histogram: IntArray
    """(BINS) pixels by grey level over `levels`"""
    levels: tuple[float, float]
    threshold: float
    """On the scale of `levels`."""
    per_mm: tuple[float, float]
    """Panel pixels per millimetre along x and y."""
    origin: tuple[float, float]
    """Where x = 0, y = 0 lies: (column, row), panel pixels."""
    turn: float = 0.0
    """rad by which the slice was turned to lie on its neighbours; the panels are as the picture is."""


class FigureSink:
    """A sink (`stackloft.contracts.sink`) that keeps one slice: the one asked for, or the largest section.

    Parameters
    ----------
    wanted : str, optional
        A slice's number from 1, or its name; None: the largest section.
    """

    def __init__(self, wanted: str | None = None) -> None:
        self._wanted = wanted
        self._number: int | None = None
        self._most = -1.0
        self._kept: SliceFigure | None = None

    def begin(self, segmentation: Segmentation) -> None:
        """Find the slice that is wanted.

        Raises
        ------
        UsageError
            There is no such slice.
        """
        self._stack = segmentation.stack
        names = self._stack.names
        if self._wanted is None:
            return
        if self._wanted in names:
            self._number = names.index(self._wanted)
        elif self._wanted.isdecimal() and 1 <= int(self._wanted) <= len(names):
            self._number = int(self._wanted) - 1
        else:
            expected = f"a number from 1 to {len(names)}, or a name such as {names[0]}"
            raise UsageError("no such slice", where=FLAG, found=self._wanted, expected=expected)

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:
        """Keep the slice when it is the one, or the largest so far."""
        if self._number is not None:
            if index == self._number:
                self._kept = self._figure(index, picture, section_field)
            return
        row, column = self._stack.pixel_spacing[index]
        size = float(np.count_nonzero(section_field.above()) * row * column)
        if size > self._most:
            self._most, self._kept = size, self._figure(index, picture, section_field)

    def end(self) -> SliceFigure | None:
        """Return the slice; None when there was none."""
        return self._kept

    def _figure(self, index: int, picture: Picture, section: SectionField) -> SliceFigure:
        window = window_of(section, picture.shape)
        part = picture[window.top : window.bottom, window.left : window.right]
        factor = SIDE / max(part.shape[:2])
        size = max(1, round(part.shape[1] * factor)), max(1, round(part.shape[0] * factor))
        grey = _own_grey(section)
        low, high = float(grey.min()), float(grey.max())
        stretch = 255.0 / (high - low) if high > low else 0.0
        turn = 0.0 if self._stack.turns is None else float(self._stack.turns[index])
        x, y = (0.0, 0.0) if self._stack.origins is None else self._stack.origins[index] @ turn_matrix(turn)
        row, column = self._stack.pixel_spacing[index]
        along = size[0] / part.shape[1], size[1] / part.shape[0]
        seen = as_rgb(resized(resizable(part), size))
        return SliceFigure(
            number=index + 1,
            name=self._stack.names[index],
            z=float(self._stack.positions[index]),
            picture=seen,
            colour=bool((np.ptp(seen.astype(np.int16), axis=2) > 3).any()),
            grey=_panel(((grey - low) * stretch).astype(np.uint8), section, window, size, None),
            binary=_panel(255 * section.above().astype(np.uint8), section, window, size, 0),
            histogram=np.histogram(grey, BINS, (low, high))[0].astype(np.int64),
            levels=(low, high),
            threshold=_own_level(section),
            per_mm=(along[0] / column, along[1] / row),
            origin=(
                (0.5 - window.left - x / column) * along[0] - 0.5,
                (0.5 - window.top - y / row) * along[1] - 0.5,
            ),
            turn=turn,
        )


def _turned(section: SectionField) -> bool:
    """Whether the field is the picture's grey turned over, as of a dark body."""
    return bool(np.isclose(section.threshold, -section.level * section.unit) and section.level < 0.0)


def _own_grey(section: SectionField) -> NDArray[Any]:
    """Return the field on the picture's own grey scale."""
    return section.values * np.float32(-section.unit if _turned(section) else section.unit)


def _own_level(section: SectionField) -> float:
    return section.level * (-section.unit if _turned(section) else section.unit)


def _panel(
    values: NDArray[np.uint8], section: SectionField, window: Window, size: tuple[int, int], fill: int | None
) -> Rgb:
    """Return the field's crop in the picture's window, small; what lies outside of the crop is `fill`."""
    rows, columns = window.bottom - window.top, window.right - window.left
    frame = np.concatenate([values[0], values[-1], values[:, 0], values[:, -1]])
    outside = int(np.median(frame)) if fill is None else fill
    whole = np.full((rows, columns), outside, dtype=np.uint8)
    top, left = section.offset[0] - window.top, section.offset[1] - window.left
    whole[top : top + values.shape[0], left : left + values.shape[1]] = values
    return as_rgb(resized(whole, size))
