"""Body and background told apart by grey level.

Grey → 3×3 median → threshold, as Goñi, Purlis & Salvadori (2007) do it; the grey levels are kept, so
that the boundary is found between the pixels. The default level is half-way between the body's edge
and the background beside it; the textbook thresholds can be chosen instead.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.model.errors import UsageError
from stackloft.model.lengths import parse_length
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SectionKind, SliceStack
from stackloft.sectioning.alignment import HOW, laid_out
from stackloft.sectioning.array_axis import AXES, MEMORY, along_axis
from stackloft.sectioning.best_axis import axis_notice, best_axis
from stackloft.sectioning.object_choice import LARGEST, one_object
from stackloft_plugins.segmenters.grey import CHANNELS
from stackloft_plugins.segmenters.histogram_levels import METHODS
from stackloft_plugins.segmenters.slab_field import SlabRules, prepared, slab_segmentation
from stackloft_plugins.segmenters.slab_level import SAMPLED
from stackloft_plugins.segmenters.slice_field import LevelRules, begun_field, mask_field


@dataclass(frozen=True, slots=True)
class HistogramSegmenter:
    """Segments by a grey-level threshold.

    Light or dark background is found from the picture's frame unless ``background`` in ``stack.toml``
    tells. ``[slice.N] threshold`` and ``mask`` there win over the options.

    Examples
    --------
    >>> from stackloft.model.slice_stack import SectionKind
    >>> plate = np.full((60, 80), 240, dtype=np.uint8)
    >>> plate[20:40, 20:60] = 90
    >>> stack = SliceStack(lambda k: plate, ("a", "b"), (60, 80), np.array([0.0, 5.0]),
    ...                    np.full((2, 2), 0.3), SectionKind.FACE)
    >>> HistogramSegmenter().segment(stack).field_of(0, plate).threshold
    165.0
    """

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (SliceStack,)
    produces: ClassVar[tuple[type, ...]] = (Segmentation,)
    general: ClassVar[bool] = True

    method: str = option(
        "half-way",
        "how the threshold is found",
        choices=("half-way", *METHODS, "manual"),
        source="module text",
    )
    threshold: float | None = option(None, "grey level of the boundary; given, no other is sought")
    scope: str = option(
        "auto",
        "a threshold for each slice, or one for the stack; auto: one for scans, else for each slice",
        choices=("auto", "slice", "stack"),
    )
    window: tuple[float, float] | None = option(
        None, "scans: least and greatest grey level (HU) of the body; given, no threshold counts"
    )
    classes: int = option(
        2, "scans: into how many classes grey levels are told (Otsu); see class", ge=2, le=4
    )
    class_: int | None = option(None, "scans: which class is the body, from 1, the darkest", ge=1, le=4)
    sample: int = option(
        SAMPLED, "scans: slices that the level is found from, evenly from first to last", ge=2
    )
    bias_field: str = option(
        "keep",
        "scans: whether brightness that varies slowly is evened out first (MR)",
        choices=("keep", "n4"),
    )
    holder: str = option(
        "keep",
        "scans: whether a table or holder, the same on all slices, is taken out",
        choices=("keep", "remove"),
    )
    holder_thickness: float | str = option(30.0, "scans: what is thicker is no holder", unit="mm", gt=0)
    voids: str = option(
        "fill", "scans: whether voids that are closed on every side count as body", choices=("fill", "keep")
    )
    split: float | None = option(
        None,
        "scans: cut bodies that touch apart where the neck between them is narrower than this part of the "
        "thinner one's width, 0.5 for food that lies together; not given, what touches is one body",
        gt=0,
        lt=1,
    )
    object: str = option(LARGEST, "scans: which body: largest, its rank by size from 1, or seed:X,Y,Z")
    axis: str = option("0", "scans: the array's axis that sections are taken across", choices=AXES)
    memory: float = option(
        MEMORY, "scans: what another axis than 0 may take for the whole scan", unit="MB", gt=0
    )
    channel: str = option("luminance", "what grey is made of", choices=tuple(CHANNELS))
    align: str = option(
        "auto",
        "photographs laid down one by one: how they are laid on each other; auto: as stack.toml says, or not",
        choices=("auto", *HOW),
    )

    def segment(self, stack: SliceStack) -> Segmentation:
        """Return the segmentation; slices are decoded here only when one threshold serves all.

        A scan's one threshold comes from a sample of at most 24 slices (`slab_level`); all of its slices are
        then looked through for bodies, and one of them is segmented.

        Raises
        ------
        UsageError
            Method ``manual`` without a threshold, or no such body.
        """
        if self.method == "manual" and self.threshold is None:
            raise UsageError("method manual needs a threshold", fix="give --set segmenter.threshold=LEVEL")
        if stack.kind is SectionKind.SLAB and self.align not in {"auto", "none"}:
            raise UsageError(
                "a scanner's slices lie where their headers say", where="--align", found=self.align
            )
        if stack.kind is SectionKind.SLAB and self.scope != "slice":
            return self._of_slabs(stack)
        if self.axis != "0":
            raise UsageError("photographs have one axis", where="--axis", found=self.axis, expected="0")
        if self.object != LARGEST:
            raise UsageError(
                "photographs show one body", where="--object", found=self.object, expected=LARGEST
            )
        threshold = self.threshold
        if self.scope == "stack" and threshold is None:
            threshold = self._median_threshold(stack)

        alone = self.channel == "luminance"
        fields = _Fields(self.method, threshold, self.channel, stack)
        return laid_out(Segmentation(stack, fields, luminance_alone=alone), self.align)

    def _of_slabs(self, stack: SliceStack) -> Segmentation:
        rules = self._slab_rules()
        ready = prepared(stack, rules)
        whole = one_object(self._told_apart(slab_segmentation(ready, rules)), self.object)
        axis, told = (int(self.axis), "") if self.axis != "auto" else best_axis(whole)
        if axis == 0:
            return replace(whole, notices=(*whole.notices, *axis_notice(told)))
        turned = along_axis(ready, axis, self.memory)
        found = one_object(self._told_apart(slab_segmentation(turned, rules)), self.object)
        return replace(found, notices=(*found.notices, *axis_notice(told)))

    def _told_apart(self, every: Segmentation) -> Segmentation:
        return replace(every, neck=self.split)

    def _slab_rules(self) -> SlabRules:
        thickness = parse_length(self.holder_thickness, "--set segmenter.holder_thickness")
        return SlabRules(
            method=self.method,
            threshold=self.threshold,
            window=self.window,
            channel=self.channel,
            fill_voids=self.voids == "fill",
            classes=self.classes,
            chosen_class=self.class_,
            sample=self.sample,
            even_out=self.bias_field == "n4",
            holder=thickness if self.holder == "remove" else None,
        )

    def _median_threshold(self, stack: SliceStack) -> float:
        decode = stack.luminance if self.channel == "luminance" else stack.decode
        fields = _Fields(self.method, None, self.channel, stack)
        return float(np.median([fields(k, decode(k)).threshold for k in range(len(stack))]))


@dataclass(frozen=True, slots=True)
class _Fields:
    """The fields of photographs by their number."""

    method: str
    threshold: float | None
    channel: str
    stack: SliceStack

    def __call__(self, number: int, picture: Picture) -> SectionField:
        return self.begun(number, picture)()

    def begun(self, number: int, picture: Picture) -> Callable[[], SectionField]:
        """Return what makes the field without the picture, when it is called."""
        hints, name = self.stack.hints, self.stack.names[number]
        said: Mapping[str, Any] = hints.slices.get(number + 1, {})
        if "mask" in said:
            return partial(mask_field, said["mask"], self.stack.shape, name, said.get("turned"))
        level = said.get("threshold", self.threshold)
        return begun_field(picture, LevelRules(self.method, level, self.channel, hints.background), name)
