"""Calls of plug-ins: whatever goes wrong in one carries its name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from stackloft.model.errors import StackloftError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SliceStack
from stackloft.registry import Loaded, failure
from stackloft.registry.work_notes import at_work


def guarded(loaded: Loaded, call: Callable[[Any], Any], argument: Any) -> Any:
    """Return ``call(argument)``, checked against what the plug-in says it produces.

    What a product does later, slice by slice, is answered for as well.

    Raises
    ------
    PluginError
        The plug-in raised something that is no StackloftError, or returned another type; plug-in
        and distribution are named.
    """
    return _answerable(loaded, checked(loaded, blaming(loaded, call, argument)))


def checked(loaded: Loaded, product: Any) -> Any:
    """Return `product`, or raise PluginError when the plug-in did not announce its type."""
    produces = tuple(loaded.plugin.produces)
    if not isinstance(product, produces):
        names = " or ".join(kind.__name__ for kind in produces)
        raise failure(loaded, TypeError(f"it returned {type(product).__name__}, announced was {names}"))
    return product


def blaming(loaded: Loaded | None, call: Callable[..., Any], *arguments: Any, doing: str = "") -> Any:
    """Return ``call(*arguments)``; what is no StackloftError becomes a PluginError that names `loaded`."""
    if loaded is None:
        return call(*arguments)
    try:
        with at_work(loaded.listing, doing or getattr(call, "__name__", "its work")):
            return call(*arguments)
    except StackloftError:
        raise
    except (Exception, SystemExit) as error:
        raise failure(loaded, error) from error


def _answerable(loaded: Loaded, product: Any) -> Any:
    """Return `product` with its slices' decoding, or their fields, laid to the plug-in's charge."""
    if isinstance(product, SliceStack) and not _answered(product.decode):
        return replace(product, decode=_Answerable(loaded, product.decode, product.shape))
    if isinstance(product, Segmentation) and not _answered(product.field_of):
        field_of = _AnswerableField(loaded, product.field_of)
        read = loaded.listing.family == "reader"  # a segmenter does not answer for a stack from memory
        stack = _answerable(loaded, product.stack) if read else product.stack
        return replace(product, stack=stack, field_of=field_of)
    return product


def _answered(call: Callable[..., Any]) -> bool:
    return isinstance(call, _Answerable | _AnswerableField)


@dataclass(frozen=True, slots=True)
class _Answerable:
    """A `decode` whose failures are its plug-in's."""

    loaded: Loaded
    decode: Callable[[int], Any]
    shape: tuple[int, int]

    def __call__(self, index: int) -> Any:
        return self._checked(self.decode, index)

    @property
    def luminance(self) -> Callable[[int], Any]:
        """The decoder's own, answered for as well."""
        own = getattr(self.decode, "luminance", None)
        return self if own is None else partial(self._checked, own)

    @property
    def at_hand(self) -> bool:
        """As the decoder says."""
        return bool(getattr(self.decode, "at_hand", False))

    @property
    def slow(self) -> bool:
        """As the decoder says."""
        return bool(getattr(self.decode, "slow", False))

    @property
    def prefetch(self) -> Callable[[Any], None] | None:
        """The decoder's own; what fails there fails again when the slice is asked for."""
        own: Callable[[Any], None] | None = getattr(self.decode, "prefetch", None)
        return own

    def _checked(self, decode: Callable[[int], Any], index: int) -> Any:
        picture = blaming(self.loaded, decode, index, doing="decode")
        if not isinstance(picture, np.ndarray) or picture.shape[:2] != tuple(self.shape):
            found = f"{type(picture).__name__} {getattr(picture, 'shape', '')}".strip()
            wrong = TypeError(f"slice {index + 1} came as {found}, announced was {tuple(self.shape)}")
            raise failure(self.loaded, wrong)
        return picture


@dataclass(frozen=True, slots=True)
class _AnswerableField:
    """A `field_of` whose failures are its plug-in's."""

    loaded: Loaded
    field_of: Callable[[int, Any], Any]

    def __call__(self, index: int, picture: Any) -> SectionField:
        return self._checked(index, blaming(self.loaded, self.field_of, index, picture, doing="segment"))

    @property
    def begun(self) -> Callable[[int, Any], Callable[[], SectionField]] | None:
        """The same in two steps, answered for as well."""
        own = getattr(self.field_of, "begun", None)
        return None if own is None else partial(self._begun, own)

    def _begun(
        self, begin: Callable[[int, Any], Any], index: int, picture: Any
    ) -> Callable[[], SectionField]:
        rest = blaming(self.loaded, begin, index, picture, doing="segment")
        return lambda: self._checked(index, blaming(self.loaded, rest, doing="segment"))

    def _checked(self, index: int, found: Any) -> SectionField:
        if isinstance(found, SectionField):
            return found
        wrong = TypeError(f"the field of slice {index + 1} came as {type(found).__name__}")
        raise failure(self.loaded, wrong)
