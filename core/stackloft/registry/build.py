"""Building plug-ins from options, and what may be said about a plug-in without running it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from stackloft.model.errors import PluginError, StackloftError, UsageError
from stackloft.registry.fields import OptionField, fields_of
from stackloft.registry.find import find
from stackloft.registry.loading import Loaded
from stackloft.registry.options_model import schema, validate
from stackloft.registry.work_notes import at_work


def build(family: str, name: str, options: Mapping[str, Any] | None = None) -> Any:
    """Return an instance of a plug-in.

    Parameters
    ----------
    family, name : str
        As for `stackloft.registry.find`.
    options : mapping, optional
        Options by name, text or typed.

    Raises
    ------
    PluginError
        The plug-in is unknown, ambiguous or broken.
    UsageError
        An option is unknown or its value not allowed.
    """
    loaded = find(family, name)
    return instantiate(loaded, validate(loaded.plugin, options or {}, loaded.key))


def instantiate(loaded: Loaded, values: Mapping[str, Any]) -> Any:
    """Return the plug-in's instance with validated `values`; its own checks speak as UsageErrors."""
    try:
        with at_work(loaded.listing, "its options' check"):
            return loaded.plugin(**values)
    except StackloftError:
        raise
    except (ValueError, TypeError) as error:
        raise UsageError(str(error), where=loaded.key) from error
    except (Exception, SystemExit) as error:
        raise failure(loaded, error) from error


def failure(loaded: Loaded, error: BaseException) -> PluginError:
    """Return what a person sees when a plug-in fails in a way that it does not explain itself."""
    listing = loaded.listing
    return PluginError(
        f"plug-in {listing.family}.{listing.name} of {listing.distribution} {listing.version} failed",
        found=f"{type(error).__name__}: {error}",
        fix=f"report it to the authors of {listing.distribution}",
    )


def options_of(family: str, name: str) -> tuple[OptionField, ...]:
    """Return the options of a plug-in with type, default, unit, bounds, choices and help."""
    return fields_of(find(family, name).plugin)


def schema_of(family: str, name: str) -> dict[str, Any]:
    """Return the JSON Schema of a plug-in's options."""
    return schema(find(family, name).plugin)


def parse_settings(items: Iterable[str]) -> dict[str, dict[str, str]]:
    """Return ``--set`` arguments as settings by ``family``, ``name`` or ``family.name``.

    Raises
    ------
    UsageError
        An argument is not ``family.option=value``, or an option is set twice.

    Examples
    --------
    >>> parse_settings(["segmenter.threshold=isodata", "reconstructor.loft.points=40"])
    {'segmenter': {'threshold': 'isodata'}, 'reconstructor.loft': {'points': '40'}}
    """
    settings: dict[str, dict[str, str]] = {}
    for item in items:
        address, equals, value = item.partition("=")
        key, dot, option = address.strip().rpartition(".")
        if not (equals and dot and key and option):
            raise UsageError("not a setting", where="--set", found=repr(item), expected="family.option=value")
        option = option.replace("-", "_")
        if option in settings.setdefault(key, {}):
            raise UsageError(f"{address.strip()} is set twice", where="--set")
        settings[key][option] = value.strip()
    return settings
