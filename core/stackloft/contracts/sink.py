"""What is fed while a stack is decoded once."""

from __future__ import annotations

from typing import Any, Protocol

from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import Picture


class Sink(Protocol):
    """Takes every slice of one decoding pass, in order, then gives its product."""

    def begin(self, segmentation: Segmentation) -> None:
        """Get ready; called once."""
        ...

    def add(self, index: int, picture: Picture, section_field: SectionField) -> None:
        """Take slice `index`; keep no reference to `picture` or the field afterwards."""
        ...

    def end(self) -> Any:
        """Return the product; called once after the last slice."""
        ...
