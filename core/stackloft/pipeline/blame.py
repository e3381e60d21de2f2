"""Calls of plug-ins: whatever goes wrong in one carries its name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from stackloft.model.errors import StackloftError
from stackloft.registry import Loaded, failure


def guarded(loaded: Loaded, call: Callable[[Any], Any], argument: Any) -> Any:
    """Return ``call(argument)``, checked against what the plug-in says it produces.

    Raises
    ------
    PluginError
        The plug-in raised something that is no StackloftError, or returned another type; plug-in
        and distribution are named.
    """
    return checked(loaded, blaming(loaded, call, argument))


def checked(loaded: Loaded, product: Any) -> Any:
    """Return `product`, or raise PluginError when the plug-in did not announce its type."""
    produces = tuple(loaded.plugin.produces)
    if not isinstance(product, produces):
        names = " or ".join(kind.__name__ for kind in produces)
        raise failure(loaded, TypeError(f"it returned {type(product).__name__}, announced was {names}"))
    return product


def blaming(loaded: Loaded | None, call: Callable[..., Any], *arguments: Any) -> Any:
    """Return ``call(*arguments)``; what is no StackloftError becomes a PluginError that names `loaded`."""
    try:
        return call(*arguments)
    except StackloftError:
        raise
    except Exception as error:
        if loaded is None:
            raise
        raise failure(loaded, error) from error
