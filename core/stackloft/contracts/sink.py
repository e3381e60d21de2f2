"""What is fed while a stack is decoded once."""

from __future__ import annotations

from typing import Any, Protocol, runtime_checkable

from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture


class Sink(Protocol):
    """Takes every slice of one decoding pass, in order, then gives its product.

    One with a false attribute `looks_at_pictures` is content with empty pictures beside the fields.
    """

    def begin(self, segmentation: Segmentation) -> None:
        """Get ready; called once."""
        ...

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:
        """Take slice `index`; keep no reference to `picture` or the field afterwards."""
        ...

    def end(self) -> Any:
        """Return the product; called once after the last slice."""
        ...


@runtime_checkable
class Streaming(Protocol):
    """A plug-in that accepts a Segmentation and can take it slice by slice.

    A run then feeds it in the one decoding pass, beside the contours; its sink's product is what its
    ``integrate`` (``reconstruct``, …) would return. One that gathers the whole volume on the way says so by
    a class variable ``needs_volume = True``; its sink raises InputError when that outgrows its memory.
    """

    def sink(self) -> Sink:
        """Return a fresh sink."""
        ...
