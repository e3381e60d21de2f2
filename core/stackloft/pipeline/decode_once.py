"""One decoding pass over a stack feeds every sink; slices are decoded ahead and dropped after use."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

from stackloft.contracts.sink import Sink
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture
from stackloft.pipeline.progress import Progress

THREADS = 2
"""Decoders and median filters release the interpreter lock; more than two threads wait for the disk."""
LOOK_AHEAD = 2
"""Slices decoded or being decoded beyond the one in use: at most 3 pictures are in memory."""

Slice = tuple[Picture, SectionField]


def decode_once(
    segmentation: Segmentation, sinks: Sequence[Sink], load: Callable[[int], Slice], progress: Progress
) -> tuple[Any, ...]:
    """Return each sink's product after one pass over the slices, in order.

    Parameters
    ----------
    segmentation : Segmentation
        Given to each sink's `begin`.
    sinks : sequence of Sink
        Called from this thread alone.
    load : callable
        Slice number to picture and field; called from worker threads.
    progress : Progress
        Told after each slice.
    """
    for sink in sinks:
        sink.begin(segmentation)
    for index, (picture, section_field) in enumerate(_ahead(load, len(segmentation))):
        for sink in sinks:
            sink.add(index, picture, section_field)
        progress.advance()
    return tuple(sink.end() for sink in sinks)


def _ahead(load: Callable[[int], Slice], count: int) -> Iterator[Slice]:
    """Yield ``load(0), load(1), …`` with at most `LOOK_AHEAD` calls running or waiting to be taken."""
    pool = ThreadPoolExecutor(THREADS, thread_name_prefix="stackloft-decode")
    pending: deque[Future[Slice]] = deque()
    numbers = iter(range(count))
    try:
        for index in numbers:
            pending.append(pool.submit(load, index))
            if len(pending) > LOOK_AHEAD - 1:
                break
        while pending:
            ready = pending.popleft().result()
            following = next(numbers, None)
            if following is not None:
                pending.append(pool.submit(load, following))
            yield ready
            del ready
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
