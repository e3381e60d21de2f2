"""The one decoding pass over a stack: every sink sees each slice once, and each answers for itself alone."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

from stackloft.contracts.sink import Sink
from stackloft.model.errors import StackloftError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture
from stackloft.pipeline.blame import blaming, checked
from stackloft.pipeline.plan import Step
from stackloft.pipeline.progress import Progress


class OwnSink:
    """A sink of the run's own (contours, a streaming plug-in) whose refusal stops nobody else."""

    def __init__(self, make: Callable[[], Sink], step: Step | None = None) -> None:
        self.product: Any = None
        self.error: StackloftError | None = None
        self.seconds = 0.0
        self._step = step
        self._sink: Sink | None = None
        self._do(lambda: self._made(make))

    @property
    def sees_pictures(self) -> bool:
        """Whether the sink may look at pictures: a plug-in's may, unless it says that it does not."""
        return (
            self._step is not None and self.error is None and getattr(self._sink, "looks_at_pictures", True)
        )

    def begin(self, segmentation: Segmentation) -> None:
        """Hand on the segmentation."""
        self._do(lambda: self._alive.begin(segmentation))

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:
        """Hand on a slice, unless the sink has refused before."""
        self._do(lambda: self._alive.add(index, picture, section_field))

    def end(self) -> None:
        """Take the product."""
        self._do(self._finish)

    def _made(self, make: Callable[[], Sink]) -> None:
        self._sink = make()

    def _finish(self) -> None:
        product = self._alive.end()
        self.product = product if self._step is None else checked(self._step.loaded, product)
        self._sink = None

    @property
    def _alive(self) -> Sink:
        if self._sink is None:
            message = "a sink that has refused is not asked again"
            raise RuntimeError(message)
        return self._sink

    def _do(self, work: Callable[[], None]) -> None:
        if self.error is not None:
            return
        start = time.perf_counter()
        try:
            blaming(self._step.loaded if self._step else None, work)
        except StackloftError as error:
            self.error, self._sink = error, None
        finally:
            self.seconds += time.perf_counter() - start


def decode_once(
    segmentation: Segmentation, own: Sequence[OwnSink], others: Sequence[Sink], progress: Progress
) -> tuple[Any, ...]:
    """Decode a stack once and feed everyone; return what the `others` give.

    Parameters
    ----------
    segmentation : Segmentation
    own : sequence of OwnSink
        Their products, or the reasons why there are none, stay with them. When all have refused there is
        no point in going on: the pass ends there.
    others : sequence of Sink
        The caller's; they give nothing when the pass ends early.
    progress : Progress
        Told about each slice.

    Raises
    ------
    StackloftError
        A slice cannot be decoded or segmented.
    """
    # tracing needs OpenCV, which contours and surfaces given as such can do without
    from stackloft.sectioning.contour_sink import decoded_ahead  # noqa: PLC0415

    progress.begin("sections", len(segmentation))
    try:
        for sink in (*own, *others):
            sink.begin(segmentation)
        looked_at = bool(others) or any(mine.sees_pictures for mine in own)
        for index, picture, section in decoded_ahead(segmentation, pictures=looked_at):
            for sink in (*own, *others):
                sink.add(index, picture, section)
            del picture, section  # or they would stay until the next ones come
            if all(mine.error for mine in own):
                return ()
            progress.advance()
        for mine in own:
            mine.end()
        return tuple(other.end() for other in others)
    finally:
        progress.end()
