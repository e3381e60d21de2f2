"""What one run gives: the figures, and the products that writers and reports need."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

from stackloft.model.contour_stack import ContourStack
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.measurement import Result
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack

T = TypeVar("T")


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """A run's result and products."""

    result: Result
    """What ``measurement.json`` holds."""
    products: tuple[Any, ...] = ()
    """Everything made, in the order it was made; those of the primary method first."""
    sink_products: tuple[Any, ...] = ()
    """What each of the caller's sinks gave at the end, in their order; empty when no slice was decoded."""

    def product(self, kind: type[T]) -> T | None:
        """Return the first product of type `kind`, or None."""
        return next((item for item in self.products if isinstance(item, kind)), None)

    @property
    def stack(self) -> SliceStack | None:
        """The slices, when slices were read."""
        return self.product(SliceStack)

    @property
    def segmentation(self) -> Segmentation | None:
        """The body on the slices, when there were slices."""
        return self.product(Segmentation)

    @property
    def contours(self) -> ContourStack | None:
        """The sections; None when the source is a surface."""
        return self.product(ContourStack)

    @property
    def solid(self) -> LoftedSolid | None:
        """The loft; None when no method made one."""
        return self.product(LoftedSolid)
