"""The field of a scan's slice: grey levels turned so that the body lies above the level."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from stackloft.model.arrays import read_only
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft_plugins.segmenters.grey import grey_levels
from stackloft_plugins.segmenters.slab_level import slab_level
from stackloft_plugins.segmenters.slice_field import mask_field


@dataclass(frozen=True, slots=True)
class SlabRules:
    """How a scan is segmented."""

    method: str = "half-way"
    threshold: float | None = None
    """Given: no other is sought."""
    window: tuple[float, float] | None = None
    """Grey levels (HU) from … to … of the body; given, no threshold counts."""
    channel: str = "luminance"
    fill_voids: bool = True


def slab_segmentation(stack: SliceStack, rules: SlabRules) -> Segmentation:
    """Return the segmentation of a scan by one level, or by a window of grey levels.

    Raises
    ------
    InputError
        The scan is blank, or shows no boundary.

    Examples
    --------
    >>> from stackloft.model.slice_stack import SectionKind
    >>> scan = np.full((40, 40), -1000.0, dtype=np.float32)
    >>> scan[8:32, 8:32] = 40.0
    >>> stack = SliceStack(lambda k: scan, ("a", "b"), (40, 40), np.array([0.0, 2.0]), np.ones((2, 2)),
    ...                    SectionKind.SLAB)
    >>> slab_segmentation(stack, SlabRules()).field_of(0, scan).threshold
    -480.0
    """
    if rules.window is not None:
        low, high = rules.window
        field = _Window(0.5 * (low + high), 0.5 * (high - low), rules.channel)
        return Segmentation(stack, _Masked(stack, field), fill_voids=rules.fill_voids)
    found = slab_level(stack, rules.method, rules.channel, stack.hints.background)
    level = found.level if rules.threshold is None else rules.threshold
    signed = _Level(level, 1.0 if found.body_above else -1.0, rules.channel)
    return Segmentation(stack, _Masked(stack, signed), notices=found.notices, fill_voids=rules.fill_voids)


@dataclass(frozen=True, slots=True)
class _Level:
    """Body on one side of a grey level."""

    level: float
    sign: float
    channel: str

    def __call__(self, picture: Picture, said: float | None) -> SectionField:
        level = self.level if said is None else said
        grey = self.sign * grey_levels(picture, self.channel).astype(np.float64)
        return SectionField(read_only(grey), self.sign * level, threshold=level)


@dataclass(frozen=True, slots=True)
class _Window:
    """Body between two grey levels: positive inside the window, falling off linearly on either side."""

    middle: float
    half: float
    channel: str

    def __call__(self, picture: Picture, said: float | None) -> SectionField:  # noqa: ARG002 - as `_Level`
        grey = grey_levels(picture, self.channel).astype(np.float64)
        return SectionField(
            read_only(self.half - np.abs(grey - self.middle)), 0.0, threshold=self.middle - self.half
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Masked:
    """A `field_of`: a mask that a person has drawn wins, then a threshold said for the slice."""

    stack: SliceStack
    field: _Level | _Window

    def __call__(self, number: int, picture: Picture) -> SectionField:
        said: Mapping[str, Any] = self.stack.hints.slices.get(number + 1, {})
        if "mask" in said:
            return mask_field(said["mask"], self.stack.shape, self.stack.names[number])
        return self.field(picture, said.get("threshold"))
