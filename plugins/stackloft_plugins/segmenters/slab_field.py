"""The field of a scan's slice: grey levels turned so that the body lies above the level."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stackloft.geometry.noise_floor import NoiseFloor
from stackloft.model.arrays import read_only
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.sectioning.kept_slices import Peeked
from stackloft_plugins.segmenters.grey import grey_levels
from stackloft_plugins.segmenters.holder import without_holder
from stackloft_plugins.segmenters.n4_bias import bias_corrected
from stackloft_plugins.segmenters.slab_classes import class_levels, class_window
from stackloft_plugins.segmenters.slab_level import SAMPLED, SlabLevel, slab_level
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
    classes: int = 2
    """Into how many classes the grey levels are told, where `chosen_class` is given or there are several."""
    chosen_class: int | None = None
    """From 1, the darkest."""
    sample: int = SAMPLED
    """Slices that the level is found from."""
    even_out: bool = False
    """Whether slowly varying brightness is divided out (N4)."""
    holder: float | None = None
    """mm: a holder no thicker than this is taken out; None: it is left where it is."""


def prepared(stack: SliceStack, rules: SlabRules) -> SliceStack:
    """Return the scan with its brightness evened out and its holder taken out, where that is asked for.

    Raises
    ------
    InputError
        There is nothing to correct, or what is the same on all slices is no holder.
    """
    if rules.even_out:
        stack = bias_corrected(stack, rules.channel)
    if rules.holder is not None:
        rough = slab_level(stack, "otsu", rules.channel, stack.hints.background, rules.sample)
        stack = without_holder(stack, rules.channel, rough, rules.holder)
    return stack


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
    peeked = Peeked(stack.decode)
    field, told, found = _field(replace(stack, decode=peeked.peek), rules)
    stack = replace(stack, decode=peeked, provenance={**stack.provenance, "grey level": told})
    return Segmentation(
        stack,
        _Masked(stack, field),
        notices=() if found is None else found.notices,
        fill_voids=rules.fill_voids,
    )


def _field(stack: SliceStack, rules: SlabRules) -> tuple[_Level | _Window, str, SlabLevel | None]:
    """Return the field of a picture, how its level was found, and what more was found with it."""
    from_sample = f"from {min(rules.sample, len(stack))} of {len(stack)} slices"
    if rules.window is not None:
        return _between(*rules.window, rules.channel), "window as given", None
    if rules.classes > 2 or rules.chosen_class is not None:
        levels = class_levels(stack, rules.channel, rules.classes, rules.sample)
        low, high = class_window(levels, rules.chosen_class)
        told = f"class {rules.chosen_class} of {rules.classes}, {low:.4g} to {high:.4g}, {from_sample}"
        return _between(low, high, rules.channel), told, None
    found = slab_level(stack, rules.method, rules.channel, stack.hints.background, rules.sample)
    given = rules.threshold is not None
    level = found.level if rules.threshold is None else rules.threshold
    told = f"{level:.5g}, as given" if given else f"{level:.5g}, {rules.method} {from_sample}"
    sign = 1.0 if found.body_above else -1.0
    return _Level(level, sign, rules.channel, found.noise), told, found


def _between(low: float, high: float, channel: str) -> _Level | _Window:
    """Return the field of a body between two grey levels, of which one may be open."""
    if high == np.inf:
        return _Level(low, 1.0, channel)
    if low == -np.inf:
        return _Level(high, -1.0, channel)
    return _Window(0.5 * (low + high), 0.5 * (high - low), channel)


@dataclass(frozen=True, slots=True)
class _Level:
    """Body on one side of a grey level."""

    level: float
    sign: float
    channel: str
    noise: NoiseFloor | None = None

    def __call__(self, picture: Picture, said: float | None) -> SectionField:
        level = self.level if said is None else said
        if self.sign > 0.0 and picture.ndim == 2:
            return SectionField(read_only(picture), level, threshold=level, noise=self.noise)
        grey = self.sign * grey_levels(picture, self.channel)
        return SectionField(read_only(grey), self.sign * level, threshold=level, noise=self.noise)


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

    @property
    def pointwise(self) -> bool:
        """True where nobody has drawn a mask, which is of whole slices."""
        return not any("mask" in said for said in self.stack.hints.slices.values())

    def __call__(self, number: int, picture: Picture) -> SectionField:
        said: Mapping[str, Any] = self.stack.hints.slices.get(number + 1, {})
        if "mask" in said:
            return mask_field(said["mask"], self.stack.shape, self.stack.names[number])
        return self.field(picture, said.get("threshold"))
