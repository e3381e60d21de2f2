"""Whether two products are the same, and whether who holds one can change it."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack
from stackloft.testing.conformance.check import NonconformingError, must


def must_be_same(one: Any, other: Any, when: str) -> None:
    """Raise `NonconformingError` when two products differ in geometry, names or decoded slices."""
    for (name, left), (_, right) in zip(_leaves(one), _leaves(other), strict=False):
        if isinstance(left, np.ndarray) and isinstance(right, np.ndarray):
            same = left.dtype == right.dtype and np.array_equal(left, right)
        else:
            same = left == right
        must(same, f"{name} differs {when}: {_short(left)} and {_short(right)}")
    must(len(list(_leaves(one))) == len(list(_leaves(other))), f"the products differ in size {when}")
    for k in range(len(one) if isinstance(one, (SliceStack, Segmentation)) else 0):
        must(np.array_equal(_picture(one, k), _picture(other, k)), f"slice {k} shows something else {when}")
        same = np.array_equal(_field(one, k), _field(other, k))
        must(same, f"the body on slice {k} is another {when}")


def must_be_frozen(product: Any) -> None:
    """Raise `NonconformingError` when a product or one of its arrays can be changed."""
    must(dataclasses.is_dataclass(product), f"{type(product).__name__} is no dataclass")
    must(type(product).__dataclass_params__.frozen, f"{type(product).__name__} is not frozen")
    for name, value in _leaves(product):
        if isinstance(value, np.ndarray):
            must(not value.flags.writeable, f"the array {name} can be written to")
        elif isinstance(value, (list, set, bytearray)):
            raise NonconformingError(f"{name} is a {type(value).__name__}, which can be changed")


def must_hand_out_fresh_slices(stack: SliceStack) -> None:
    """Raise `NonconformingError` when writing into a decoded slice shows when it is decoded again."""
    first = stack.decode(0)
    expected = first.copy()
    if first.flags.writeable:
        first[...] = 0
    must(np.array_equal(stack.decode(0), expected), "writing into a decoded slice changes the stack")


def _leaves(value: Any, name: str = "product") -> Iterator[tuple[str, Any]]:
    """Yield what a product is made of; functions, and how it was learned, are left out."""
    if callable(value):
        return
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        for item in dataclasses.fields(value):
            if item.name != "provenance":
                yield from _leaves(getattr(value, item.name), f"{name}.{item.name}")
    elif isinstance(value, (tuple, list)):
        if isinstance(value, list):
            yield name, value
        for number, part in enumerate(value):
            yield from _leaves(part, f"{name}[{number}]")
    elif isinstance(value, Mapping):
        for key in sorted(value, key=str):
            yield from _leaves(value[key], f"{name}[{key!r}]")
    else:
        yield name, value


def _picture(product: SliceStack | Segmentation, k: int) -> Any:
    stack = product.stack if isinstance(product, Segmentation) else product
    return stack.decode(k)


def _field(product: SliceStack | Segmentation, k: int) -> Any:
    """Return a slice's field above its level; nothing of a stack that is not segmented yet."""
    if isinstance(product, SliceStack):
        return np.zeros(0)
    section = product.field_of(k, product.stack.decode(k))
    return section.values - section.level


def _short(value: Any) -> str:
    text = repr(value).replace("\n", " ")
    return text if len(text) < 80 else f"{text[:77]}…"
