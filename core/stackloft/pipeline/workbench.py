"""The products of one run, each made once: the memo that methods share."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from stackloft.contracts.sink import Sink
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import PluginError, StackloftError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture, SliceStack
from stackloft.pipeline.chain_check import ladder
from stackloft.pipeline.plan import Plan, Step
from stackloft.pipeline.progress import Progress
from stackloft.registry import RUN, Loaded, failure, plain


@dataclass(frozen=True, slots=True)
class Item:
    """A product with its identity: the plug-ins, options and input it came from."""

    value: Any
    identity: str


class Workbench:
    """Makes products when they are asked for, and remembers them (and failures) for one run."""

    def __init__(self, plan: Plan, product: Any, progress: Progress, sinks: Sequence[Sink] = ()) -> None:
        self.root = Item(product, "source")
        self.seconds: dict[str, float] = {}
        """Seconds of each piece of work by its identity."""
        self.stages: dict[str, float] = {}
        """Seconds by ``family.name``; ``sections`` is the decoding pass with its contours."""
        self.made: dict[str, Any] = {"source": product}
        """Products by identity, in the order in which they were made."""
        self.sink_products: tuple[Any, ...] = ()
        self._plan = plan
        self._progress = progress
        self._sinks = tuple(sinks)
        self._failures: dict[str, StackloftError] = {}

    def run(self, steps: Sequence[Step]) -> tuple[Any, list[str]]:
        """Return the last step's product, and the identities of the work of these steps."""
        item, work = self.root, []
        for step in steps:
            item = self.apply(step, self.fit(item, tuple(step.loaded.plugin.accepts), step.key))
            work.append(item.identity)
        return item.value, work

    def apply(self, step: Step, item: Item) -> Item:
        """Return what `step` makes of `item`."""
        options = json.dumps({name: plain(value) for name, value in step.options.items()}, sort_keys=True)
        return self._once(
            f"{step.loaded.listing.qualified}{options}({item.identity})",
            step.key,
            lambda: guarded(step.loaded, getattr(step.instance, RUN[step.loaded.family]), item.value),
        )

    def fit(self, item: Item, accepts: tuple[type, ...], taker: str) -> Item:
        """Return `item`, or what follows from it on the ladder, as the first type that `accepts` names."""
        rungs = ladder(type(item.value), segmented=self._plan.segmenter is not None)
        for accepted in accepts:
            for rung in rungs:
                if issubclass(rung, accepted):
                    return self._climb(item, rung)
        need = " or ".join(kind.__name__ for kind in accepts)
        raise PluginError(f"{taker} cannot take {type(item.value).__name__}", expected=need)

    def contours(self) -> ContourStack | None:
        """Return the sections of what was read; None for a surface, which has none."""
        if ContourStack not in ladder(type(self.root.value), segmented=self._plan.segmenter is not None):
            return None
        contours: ContourStack = self._climb(self.root, ContourStack).value
        return contours

    def _climb(self, item: Item, rung: type) -> Item:
        if isinstance(item.value, rung):
            return item
        if isinstance(item.value, SliceStack) and self._plan.segmenter is not None:
            return self._climb(self.apply(self._plan.segmenter, item), rung)
        return self._once(f"contours({item.identity})", "sections", lambda: self._trace(item))

    def _trace(self, item: Item) -> ContourStack:
        """Run the one decoding pass; the caller's sinks see the slices of the plan's own segmentation."""
        # tracing needs OpenCV, which contours and surfaces given as such can do without
        from stackloft.sectioning.contour_sink import ContourSink, feed  # noqa: PLC0415

        segmentation: Segmentation = item.value
        first = not any(name.startswith("contours(") for name in self.made)
        sinks = (ContourSink(), *(self._sinks if first else ()), _Teller(self._progress))
        self._progress.begin("sections", len(segmentation))
        try:
            contours, *others, _ = feed(self._blamed(segmentation), sinks)
        finally:
            self._progress.end()
        if first:
            self.sink_products = tuple(others)
        result: ContourStack = contours
        return result

    def _blamed(self, segmentation: Segmentation) -> Segmentation:
        """Return the same slices, with the plug-in named whenever decoding or segmenting one crashes."""
        reader = self._plan.reader.loaded if self._plan.reader else None
        segmenter = self._plan.segmenter.loaded if self._plan.segmenter else reader
        stack = segmentation.stack
        return replace(
            segmentation,
            stack=replace(stack, decode=partial(_blaming, reader, stack.decode)),
            field_of=partial(_blaming, segmenter, segmentation.field_of),
        )

    def _once(self, identity: str, stage: str, make: Callable[[], Any]) -> Item:
        if identity in self._failures:
            raise self._failures[identity]
        if identity not in self.made:
            start = time.perf_counter()
            own_bar = stage != "sections"
            try:
                if own_bar:
                    self._progress.begin(stage, None)
                self.made[identity] = make()
            except StackloftError as error:
                self._failures[identity] = error
                raise
            finally:
                self.seconds[identity] = time.perf_counter() - start
                self.stages[stage] = self.stages.get(stage, 0.0) + self.seconds[identity]
                if own_bar:
                    self._progress.end()
        return Item(self.made[identity], identity)


class _Teller:
    """A `Sink` that only tells the progress display that one more slice is done."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress

    def begin(self, segmentation: Segmentation) -> None:
        pass

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:  # noqa: ARG002
        self._progress.advance()

    def end(self) -> None:
        pass


def guarded(loaded: Loaded, call: Callable[[Any], Any], argument: Any) -> Any:
    """Return ``call(argument)``, checked against what the plug-in says it produces.

    Raises
    ------
    PluginError
        The plug-in raised something that is no StackloftError, or returned another type; plug-in
        and distribution are named.
    """
    product = _blaming(loaded, call, argument)
    produces = tuple(loaded.plugin.produces)
    if not isinstance(product, produces):
        names = " or ".join(kind.__name__ for kind in produces)
        raise failure(loaded, TypeError(f"it returned {type(product).__name__}, announced was {names}"))
    return product


def _blaming(loaded: Loaded | None, call: Callable[..., Any], *arguments: Any) -> Any:
    try:
        return call(*arguments)
    except StackloftError:
        raise
    except Exception as error:
        if loaded is None:
            raise
        raise failure(loaded, error) from error
