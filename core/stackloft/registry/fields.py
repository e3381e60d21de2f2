"""A plug-in's options, read off its dataclass fields."""

from __future__ import annotations

import dataclasses
import types
from collections.abc import Mapping
from functools import cache
from typing import Any, Union, get_args, get_origin, get_type_hints

from stackloft.contracts.recipe import Recipe


@dataclasses.dataclass(frozen=True, slots=True)
class OptionField:
    """One option as its author declared it with `stackloft.contracts.options.option`."""

    name: str
    annotation: Any
    """Its type, without the ``| None`` of an option that may be left open."""
    optional: bool
    """True when None is allowed; written ``none`` in text."""
    default: Any
    help: str = ""
    unit: str = ""
    bounds: Mapping[str, float] = dataclasses.field(default_factory=dict)
    """``ge``, ``gt``, ``le``, ``lt``"""
    choices: tuple[str, ...] | None = None
    source: str | None = None
    """Where the default comes from."""

    @property
    def type_name(self) -> str:
        """Its type as people read it, for example ``float`` or ``tuple[float, ...]``."""
        plain_class = isinstance(self.annotation, type) and not get_args(self.annotation)
        name: str = self.annotation.__name__ if plain_class else str(self.annotation)
        return f"{name} or none" if self.optional else name


@cache
def fields_of(plugin: Any) -> tuple[OptionField, ...]:
    """Return the options of a plug-in class, in the order of their declaration.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> from stackloft.contracts.options import option
    >>> @dataclass(frozen=True)
    ... class Threshold:
    ...     level: float | None = option(None, "grey level", ge=0)
    >>> fields_of(Threshold)[0].type_name
    'float or none'
    """
    if isinstance(plugin, Recipe):
        return ()
    hints = get_type_hints(plugin, include_extras=True)
    return tuple(_field(item, hints[item.name]) for item in dataclasses.fields(plugin) if item.init)


def _field(item: dataclasses.Field[Any], hint: Any) -> OptionField:
    said = item.metadata.get("stackloft", {})
    annotation, optional = _core_type(hint, length=said.get("unit") == "mm")
    known = {key: said[key] for key in ("help", "unit", "bounds", "choices", "source") if key in said}
    return OptionField(item.name, annotation, optional, default_of(item), **known)


def default_of(item: dataclasses.Field[Any]) -> Any:
    """Return the value a field takes when nobody gives one."""
    return item.default if item.default_factory is dataclasses.MISSING else item.default_factory()


def _core_type(hint: Any, *, length: bool) -> tuple[Any, bool]:
    """Return `hint` without None, and whether None was allowed; text for a length is parsed anyway."""
    if get_origin(hint) not in {Union, types.UnionType}:
        return hint, False
    rest = tuple(part for part in get_args(hint) if part is not types.NoneType)
    optional = len(rest) < len(get_args(hint))
    if length and len(rest) > 1:
        rest = tuple(part for part in rest if part is not str)
    return (rest[0] if len(rest) == 1 else Union[rest]), optional  # noqa: UP007 - built at run time
