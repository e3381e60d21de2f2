"""A plug-in that takes slices one by one, run on its own."""

from __future__ import annotations

from typing import TypeVar

from stackloft.contracts.sink import Streaming
from stackloft.model.segmentation import Segmentation
from stackloft.sectioning.contour_sink import feed

T = TypeVar("T")


def streamed(segmentation: Segmentation, plugin: Streaming, kind: type[T]) -> T:
    """Return what the plug-in's sink makes of a segmentation in a decoding pass of its own.

    Raises
    ------
    TypeError
        It is no `kind`.
    """
    (product,) = feed(segmentation, [plugin.sink()])
    if not isinstance(product, kind):
        raise TypeError(type(product).__name__)
    return product
