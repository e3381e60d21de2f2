"""The products of one run, each made once: the memo that methods share."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from stackloft.contracts.sink import Sink, Streaming
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import PluginError, StackloftError
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack
from stackloft.pipeline.blame import guarded
from stackloft.pipeline.chain_check import ladder
from stackloft.pipeline.decoding import OwnSink, decode_once
from stackloft.pipeline.plan import Plan, Step
from stackloft.pipeline.progress import Progress
from stackloft.registry import RUN, plain

__all__ = ["Item", "Workbench", "guarded"]


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
        """Return what `step` makes of `item`; a step that takes slices one by one joins the decoding pass."""
        identity = _identity(step, item)
        if isinstance(step.instance, Streaming) and isinstance(item.value, Segmentation):
            return self._decoded(identity, step, item)
        return self._once(
            identity,
            step.key,
            lambda: guarded(step.loaded, getattr(step.instance, RUN[step.loaded.family]), item.value),
        )

    def fit(self, item: Item, accepts: tuple[type, ...], taker: str) -> Item:
        """Return `item`, or what follows from it on the ladder, as the first type that `accepts` names."""
        rung = self._rung(type(item.value), accepts)
        if rung is None:
            need = " or ".join(kind.__name__ for kind in accepts)
            raise PluginError(f"{taker} cannot take {type(item.value).__name__}", expected=need)
        return self._climb(item, rung)

    def _rung(self, kind: type, accepts: tuple[type, ...]) -> type | None:
        rungs = ladder(kind, segmented=self._plan.segmenter is not None)
        return next((rung for accepted in accepts for rung in rungs if issubclass(rung, accepted)), None)

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
        return self._decoded(f"contours({item.identity})", None, item)

    def _decoded(self, identity: str, step: Step | None, item: Item) -> Item:
        """Return what the decoding pass gives under `identity`, run now unless it has been."""
        if identity not in self.made and identity not in self._failures:
            self._decode(item, step)
        if identity in self._failures:
            raise self._failures[identity]
        return Item(self.made[identity], identity)

    def _decode(self, item: Item, step: Step | None) -> None:
        """Run the one decoding pass; the caller's sinks see the slices of the plan's own segmentation."""
        from stackloft.sectioning.contour_sink import ContourSink  # noqa: PLC0415 - it needs OpenCV

        contours = f"contours({item.identity})"
        planned = self._streaming() if self._is_own(item) else ()
        steps = {_identity(one, item): one for one in (*planned, *([step] if step else []))}
        own = {contours: OwnSink(ContourSink)} | {
            key: OwnSink(x.instance.sink, x) for key, x in steps.items()
        }
        own = {key: sink for key, sink in own.items() if key not in self.made and key not in self._failures}
        others, self._sinks = (self._sinks, ()) if self._is_own(item) else ((), self._sinks)
        start = time.perf_counter()
        try:
            given = decode_once(item.value, tuple(own.values()), others, self._progress)
            self.sink_products = self.sink_products or given
        except StackloftError as error:
            self._failures |= dict.fromkeys(own, error)
        self._failures |= {key: sink.error for key, sink in own.items() if sink.error is not None}
        self.made |= {key: sink.product for key, sink in own.items() if key not in self._failures}
        whole = time.perf_counter() - start
        for key, sink in own.items():
            self._took(key, steps[key].key if key in steps else "sections", sink.seconds)
        self._took(contours, "sections", whole - sum(sink.seconds for sink in own.values()))

    def _is_own(self, item: Item) -> bool:
        """Return whether `item` is what was read, or what the plan's segmenter made of it."""
        segmenter = self._plan.segmenter
        made = _identity(segmenter, self.root) if segmenter is not None else None
        return item.identity in {self.root.identity, made}

    def _streaming(self) -> Iterator[Step]:
        """Yield the methods' first steps that take what was read slice by slice."""
        for method in self._plan.methods:
            for step in method.steps[:1]:
                rung = self._rung(type(self.root.value), tuple(step.loaded.plugin.accepts))
                if (
                    isinstance(step.instance, Streaming)
                    and rung is not None
                    and issubclass(rung, Segmentation)
                ):
                    yield step

    def _took(self, identity: str, stage: str, seconds: float) -> None:
        self.seconds[identity] = self.seconds.get(identity, 0.0) + seconds
        self.stages[stage] = self.stages.get(stage, 0.0) + seconds

    def _once(self, identity: str, stage: str, make: Callable[[], Any]) -> Item:
        if identity in self._failures:
            raise self._failures[identity]
        if identity not in self.made:
            start = time.perf_counter()
            self._progress.begin(stage, None)
            try:
                self.made[identity] = make()
            except StackloftError as error:
                self._failures[identity] = error
                raise
            finally:
                self._took(identity, stage, time.perf_counter() - start)
                self._progress.end()
        return Item(self.made[identity], identity)


def _identity(step: Step, item: Item) -> str:
    options = json.dumps({name: plain(value) for name, value in step.options.items()}, sort_keys=True)
    return f"{step.loaded.listing.qualified}{options}({item.identity})"
