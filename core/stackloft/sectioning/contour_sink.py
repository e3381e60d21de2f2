"""One decoding pass over a stack: every slice's loops, gathered into a `ContourStack`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from stackloft.contracts.sink import Sink
from stackloft.model.contour_stack import ContourStack, Section
from stackloft.model.notices import Notice
from stackloft.model.reused_memory import memory_reused
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SectionKind
from stackloft.sectioning.ahead import HELD, THREADS, TOGETHER, Behind, ahead_on, groups_of, worked_ahead
from stackloft.sectioning.limbs import with_limbs
from stackloft.sectioning.loop_curves import remember_smooth
from stackloft.sectioning.loop_numbers import said_links
from stackloft.sectioning.opencv_threads import without_opencv_threads
from stackloft.sectioning.silhouettes import SETTLED
from stackloft.sectioning.slab_contours import on_middle_planes
from stackloft.sectioning.slice_lines import SliceToTrace, TraceRules
from stackloft.sectioning.stack_hazards import stack_hazards
from stackloft.sectioning.strays import without_strays
from stackloft.sectioning.traced_slices import traced_slices

_NO_PICTURE: Picture = np.zeros((0, 0), np.uint8)
_NAMED = 3  # slices named in a notice that stands for several


class ContourSink:
    """Traces each slice as it comes by, corners and all; ends with the stack of sections.

    Examples
    --------
    >>> import numpy as np
    >>> from stackloft.model.slice_stack import SectionKind, SliceStack
    >>> picture = np.full((30, 30), 20.0)
    >>> picture[10:20, 10:20] = 100.0
    >>> stack = SliceStack(lambda k: picture, ("a", "b"), (30, 30), np.array([0.0, 5.0]),
    ...                    np.full((2, 2), 0.5), SectionKind.FACE)
    >>> contours = trace_stack(Segmentation(stack, lambda k, picture: SectionField(picture, 60.0)))
    >>> len(contours), contours.resolution
    (2, 0.5)
    """

    def __init__(self, rules: TraceRules | None = None) -> None:
        self._rules = rules or TraceRules()
        self._segmentation: Segmentation | None = None
        self._waiting: list[tuple[int, SliceToTrace]] = []
        self._behind = Behind()

    def begin(self, segmentation: Segmentation) -> None:
        """Get ready for the slices of `segmentation`."""
        self._segmentation = segmentation
        self._waiting, self._behind = [], Behind(THREADS if ahead_on(segmentation.stack) else 0)

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:  # noqa: ARG002 - a Sink
        """Have slice `index` traced, together with some before and after it.

        Raises
        ------
        InputError
            There is no body on it, or on one of those before.
        """
        stack = self._begun.stack
        row, column = (float(step) for step in stack.pixel_spacing[index])
        one = SliceToTrace(section_field, (row, column), stack.shape, stack.names[index])
        self._waiting.append((index, one))
        held = sum(slice_.section.values.nbytes for _, slice_ in self._waiting)
        if held > HELD:
            self._behind.settle()
        if len(self._waiting) == TOGETHER or held > HELD:
            self._hand_over()
        if len(self._waiting) == 1 and index == 0:  # where the first slice shows no body, seldom another does
            self._hand_over()
            self._behind.settle()

    def end(self) -> ContourStack:
        """Return the sections, with what the stack said and what was noticed on the way."""
        segmentation = self._begun
        stack = segmentation.stack
        self._hand_over()
        traced = [one for some in self._behind.finished() for one in some]
        sections, left_out = with_limbs([one.section for one in traced], [one.perhaps for one in traced])
        notices = [*(notice for one in traced for notice in one.notices), *left_out]
        if stack.kind is SectionKind.SLAB and not segmentation.binary:
            sections = on_middle_planes(sections, stack)
        if stack.kind is not SectionKind.SLAB:
            sections, notices = _strays_aside(sections, [one.at_border for one in traced], notices)
        contours = ContourStack(
            sections=tuple(sections),
            kind=stack.kind,
            exact=False,
            resolution=float(stack.pixel_spacing.max()),
            thickness=None if stack.thickness is None else float(stack.thickness.mean()),
            seen_beyond=_seen_beyond(segmentation),
            affine=stack.affine,
            scale_uncertainty=stack.scale_uncertainty,
            hints=replace(stack.hints, links=said_links(stack.hints.slices, stack.names)),
            notices=(*stack.notices, *segmentation.notices, *gathered(notices), *self._mistakes(sections)),
            provenance=stack.provenance,
        )
        remember_smooth(contours, {loop: smooth for one in traced for loop, smooth in one.smooth.items()})
        return contours

    def _hand_over(self) -> None:
        some, self._waiting = self._waiting, []
        if some:
            stack, rules = self._begun.stack, self._rules
            self._behind.give(lambda: traced_slices(some, stack, rules))

    def _mistakes(self, sections: list[Section]) -> tuple[Notice, ...]:
        """Return what the sections of photographs say of mistakes; a scanner takes its slices in order."""
        stack = self._begun.stack
        if stack.kind is SectionKind.SLAB or SETTLED in stack.provenance:
            return ()
        return stack_hazards(sections, float(stack.pixel_spacing.max()))

    @property
    def _begun(self) -> Segmentation:
        if self._segmentation is None:
            message = "begin() comes first"
            raise RuntimeError(message)
        return self._segmentation


def _seen_beyond(segmentation: Segmentation) -> tuple[float, float]:
    """Return how far beyond the first and the last slice the body still shows, mm."""
    z = segmentation.stack.positions
    first = [z[0] - beyond.position for beyond in segmentation.before if beyond.shown]
    last = [beyond.position - z[-1] for beyond in segmentation.after if beyond.shown]
    return float(max(first, default=0.0)), float(max(last, default=0.0))


def _strays_aside(
    sections: list[Section], at_border: list[tuple[bool, ...]], notices: list[Notice]
) -> tuple[list[Section], list[Notice]]:
    """Take what one photograph alone shows out of the sections; what was said of it goes too."""
    kept, told = without_strays(sections, at_border)
    gone = tuple(f"{one.message.partition(': ')[0]}: " for one in told if one.code == "edge-object")
    said = [one for one in notices if one.code != "border-contact" or not one.message.startswith(gone)]
    return kept, [*said, *told]


def trace_stack(segmentation: Segmentation, rules: TraceRules | None = None) -> ContourStack:
    """Return the sections of a segmented stack, decoding each slice once.

    Raises
    ------
    InputError
        A slice cannot be decoded, or shows no body.
    """
    (contours,) = feed(segmentation, [ContourSink(rules)])
    if not isinstance(contours, ContourStack):  # a sink's product is of any type
        raise TypeError(type(contours).__name__)
    return contours


def feed(segmentation: Segmentation, sinks: Sequence[Sink]) -> list[Any]:
    """Decode a stack once, give every slice to every sink in order, and return their products."""
    for sink in sinks:
        sink.begin(segmentation)
    for index, picture, section in decoded_ahead(segmentation):
        for sink in sinks:
            sink.add(index, picture, section)
        del picture, section  # or they would stay until the next ones come
    return [sink.end() for sink in sinks]


def decoded_ahead(
    segmentation: Segmentation, *, pictures: bool = True
) -> Iterator[tuple[int, Picture, SectionField]]:
    """Yield slice number, picture and field in order, decoding and segmenting a little ahead.

    Two threads work ahead (`worked_ahead`), less far where pictures are large, and not at all on a scan's
    small slices (`ahead_on`). Where nobody looks at the `pictures`, an empty one is given and nothing of them
    stays in memory.
    """

    def work(index: int) -> tuple[int, Picture, SectionField]:
        if not pictures:
            return index, _NO_PICTURE, segmentation.field_at(index)
        picture = segmentation.stack.decode(index)
        return index, picture, segmentation.field_beside(index, picture)

    ahead = ahead_on(segmentation.stack)
    with without_opencv_threads(), memory_reused():
        if ahead:
            yield from worked_ahead(len(segmentation), work, ahead)
            return
        for group in groups_of(len(segmentation), TOGETHER):
            segmentation.stack.prefetch(group)
            yield from map(work, group)


def gathered(notices: Sequence[Notice]) -> tuple[Notice, ...]:
    """Return one notice for each code: the first slice's words, and how many others it is about.

    Examples
    --------
    >>> gathered([Notice("low-contrast", "a: faint"), Notice("low-contrast", "b: faint")])[0].message
    'a: faint (and 1 more: b)'
    """
    groups: dict[str, list[Notice]] = {}
    for notice in notices:
        groups.setdefault(notice.code, []).append(notice)
    return tuple(_merged(group) for group in groups.values())


def _merged(group: list[Notice]) -> Notice:
    first, *others = group
    if not others:
        return first
    names = [other.message.partition(": ")[0] for other in others]
    more = ", …" if len(names) > _NAMED else ""
    return Notice(first.code, f"{first.message} (and {len(names)} more: {', '.join(names[:_NAMED])}{more})")
