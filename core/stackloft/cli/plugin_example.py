"""A command line that uses a plug-in, for ``plugins show``."""

from __future__ import annotations

from collections.abc import Sequence

from stackloft.contracts.recipe import Recipe
from stackloft.model.measurement import Result
from stackloft.registry.fields import OptionField, fields_of
from stackloft.registry.loading import Loaded, load
from stackloft.registry.options_model import plain
from stackloft.registry.scan import catalogue


def example_of(loaded: Loaded) -> str:
    """Return a command line in which the plug-in runs, with the first of its options set.

    Examples
    --------
    >>> from stackloft.registry import find
    >>> example_of(find("writer", "ply"))
    'stackloft measure SOURCE --out DIR --write ply --set writer.ply.tolerance=0.02'
    """
    name = loaded.listing.qualified if loaded.listing.clash else loaded.name
    start = "stackloft measure SOURCE"
    if loaded.family == "recipe":
        return f"{start} --method {name}"
    if loaded.family == "writer":
        by_name = "" if Result in loaded.plugin.accepts else f" --write {name}"
        return f"{start} --out DIR{by_name}{_setting(loaded)}"
    if loaded.family == "reader":
        return f"{start} --reader {name}{_setting(loaded)}"
    if loaded.family == "segmenter":
        return f"{start}{_setting(loaded)}"
    methods = _methods_with(f"{loaded.family}.{loaded.name}")
    return f"{start} --method {methods[0] if methods else 'RECIPE'}{_setting(loaded)}"


def _setting(loaded: Loaded) -> str:
    said = next(filter(None, (_written(item) for item in fields_of(loaded.plugin))), "")
    return f" --set {loaded.key}.{said}" if said else ""


def _written(item: OptionField) -> str:
    """Return ``option=value`` with a value that the option takes, nothing when its default tells none."""
    if item.default is None:
        return f"{item.name}={5.0 if item.annotation is float else 'LENGTH'}mm" if item.unit == "mm" else ""
    value = plain(item.default)
    text = ",".join(map(str, value)) if isinstance(value, list) else str(value)
    return f"{item.name}={text}" if text and " " not in text else ""


def _methods_with(step: str) -> Sequence[str]:
    """Return the recipes that contain a step."""
    outcomes = [load(listing) for listing in catalogue("recipe")]
    recipes = [x for x in outcomes if isinstance(x, Loaded) and isinstance(x.plugin, Recipe)]
    return [loaded.name for loaded in recipes if step in loaded.plugin.steps]
