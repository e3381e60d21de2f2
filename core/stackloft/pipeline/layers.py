"""Which value each option takes when defaults, the method, a recipe file, flags and settings all speak."""

from __future__ import annotations

import keyword
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from stackloft.model.errors import PluginError, UsageError
from stackloft.model.notices import Notice
from stackloft.pipeline.request import MeasureRequest
from stackloft.registry import Loaded, catalogue, fields_of, nearest, validate

Settings = Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True, slots=True)
class Place:
    """One plug-in's place in a run: what options can be addressed to."""

    loaded: Loaded
    method: str | None = None
    """The method whose step it is; None for the reader and the segmenter."""
    preset: Mapping[str, Any] = field(default_factory=dict)
    """What the method itself sets (`Recipe.options`)."""

    @property
    def addresses(self) -> tuple[str, ...]:
        """The keys that mean this place, the least particular first."""
        listing = self.loaded.listing
        own = (listing.family, listing.name, listing.qualified, f"{listing.family}.{listing.name}")
        keys = (*own, f"{listing.family}.{listing.qualified}")
        return (*keys, f"{self.method}/{self.loaded.key}") if self.method else keys

    @property
    def names(self) -> frozenset[str]:
        """The names of its options."""
        return frozenset(item.name for item in fields_of(self.loaded.plugin))


def options_at(place: Place, request: MeasureRequest) -> dict[str, Any]:
    """Return every option of the plug-in at `place`, validated (order as in `MeasureRequest`)."""
    merged = _taken(place, place.preset) | _addressed(place, request.base)
    merged |= _taken(place, request.shared)
    merged |= _addressed(place, request.settings)
    return validate(place.loaded.plugin, merged, place.loaded.key)


def check_preset(place: Place) -> None:
    """Raise PluginError when a method itself sets an option that is unknown or not allowed."""
    try:
        validate(place.loaded.plugin, place.preset, place.loaded.key)
    except UsageError as error:
        raise PluginError(f"method {place.method} sets its own options wrongly", found=str(error)) from error


def check_addresses(places: Iterable[Place], request: MeasureRequest) -> tuple[Notice, ...]:
    """Refuse flags and settings that reach no plug-in of the run; return notices on unused recipe keys.

    Raises
    ------
    UsageError
        A setting's key is no plug-in of the run, no plug-in at that key has the option, or a general
        flag is of no use to any plug-in of the run.
    """
    chain = tuple(places)
    for name in request.shared:
        if not any(_spelt(name) in place.names for place in chain):
            taken = sorted({option for place in chain for option in place.names})
            flag = f"--{name.replace('_', '-')}"
            used = ", ".join(dict.fromkeys(place.loaded.key for place in chain))
            raise UsageError(
                f"no plug-in of this run ({used}) takes it", where=flag, fix=nearest(name, taken)
            )
    for key, options in request.settings.items():
        _check_key(key, options, chain, "--set")
    unused = [key for key in request.base if _elsewhere(key, chain)]
    for key in request.base:
        if key not in unused:
            _check_key(key, request.base[key], chain, "recipe")
    text = "the recipe file sets options of {}, which has no part in this run"
    return tuple(Notice("recipe-unused", text.format(key)) for key in unused)


def _check_key(key: str, options: Mapping[str, Any], chain: tuple[Place, ...], where: str) -> None:
    places = [place for place in chain if key in place.addresses]
    if not places:
        known = [address for place in chain for address in place.addresses]
        hint = nearest(key, list(dict.fromkeys(known)))
        raise UsageError(f"no plug-in of this run is addressed by {key!r}", where=where, fix=hint)
    for option in options:
        names = sorted({name for place in places for name in place.names})
        if _spelt(option) not in names:
            keys = ", ".join(dict.fromkeys(place.loaded.key for place in places))
            raise UsageError(f"{keys} has no option {option!r}", where=where, fix=nearest(option, names))


def _elsewhere(key: str, chain: tuple[Place, ...]) -> bool:
    """Tell whether `key` means an installed plug-in that has no place in this run."""
    if any(key in place.addresses for place in chain):
        return False
    bare = key.rpartition("/")[2]
    return any(bare in {x.family, x.name, x.key, f"{x.family}.{x.name}"} for x in catalogue())


def _addressed(place: Place, settings: Settings) -> dict[str, Any]:
    merged: dict[str, Any] = {}
    for address in place.addresses:
        merged |= _taken(place, settings.get(address, {}))
    return merged


def _taken(place: Place, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return those `options` that the plug-in has; `check_addresses` answers for the others."""
    spelt = {_spelt(name): value for name, value in options.items()}
    return {name: value for name, value in spelt.items() if name in place.names}


def _spelt(name: str) -> str:
    """Return the field that an option's name means: ``class``, a word of Python's own, is ``class_``."""
    spelt = name.replace("-", "_")
    return f"{spelt}_" if keyword.iskeyword(spelt) else spelt
