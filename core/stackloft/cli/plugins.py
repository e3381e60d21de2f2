"""``stackloft plugins show``: what a plug-in does, its options, where it comes from, how it is used."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from stackloft.cli.plugin_example import example_of
from stackloft.cli.plugin_list import row
from stackloft.cli.plugin_names import listings_called, print_json
from stackloft.cli.screen import console
from stackloft.contracts.recipe import Recipe
from stackloft.registry.alone import load_each_alone
from stackloft.registry.fields import OptionField, fields_of
from stackloft.registry.glance import glance
from stackloft.registry.loading import Loaded, Quarantined, load
from stackloft.registry.options_model import plain, schema
from stackloft.registry.scan import Listing

Outcome = Loaded | Quarantined

_SIGNS = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<"}


def show(name: str, *, as_json: bool) -> None:
    """Print what the plug-ins called `name` do, and their options.

    Parameters
    ----------
    name : str
        A name, ``family.name``, ``distribution:name`` or ``family.distribution:name``.

    Raises
    ------
    PluginError
        No plug-in has that name.
    """
    outcomes = [_loaded(listing) for listing in listings_called(name)]
    if as_json:
        print_json([_details(outcome) for outcome in outcomes])
        return
    screen = console()
    for number, outcome in enumerate(outcomes):
        if number:
            screen.print()
        _describe(screen, outcome)


def _loaded(listing: Listing) -> Outcome:
    """Return the plug-in; a stranger's is tried in a process of its own first, as it may crash that."""
    if listing.distribution != "stackloft":
        (health,) = load_each_alone([listing])
        if health.reason:
            return Quarantined(listing, health.reason, health.traceback)
    return load(listing)


def _details(outcome: Outcome) -> dict[str, Any]:
    seen = glance(outcome.listing)
    said: dict[str, Any] = {**row(seen), "source": str(seen.path) if seen.path else None}
    if isinstance(outcome, Quarantined):
        return {**said, "state": "quarantined", "reason": outcome.reason, "traceback": outcome.traceback}
    plugin = outcome.plugin
    said |= {"api": plugin.api, "example": example_of(outcome)}
    if isinstance(plugin, Recipe):
        options = {key: dict(values) for key, values in plugin.options.items()}
        return {**said, "about": plugin.summary, "steps": list(plugin.steps), "options": options}
    return {
        **said,
        "about": about(plugin),
        "accepts": [kind.__name__ for kind in plugin.accepts],
        "produces": [kind.__name__ for kind in plugin.produces],
        "options": [_option(field) for field in fields_of(plugin)],
        "schema": schema(plugin),
    }


def _option(field: OptionField) -> dict[str, Any]:
    return {
        "name": field.name,
        "type": field.type_name,
        "default": plain(field.default),
        "unit": field.unit,
        "bounds": dict(field.bounds),
        "choices": None if field.choices is None else list(field.choices),
        "help": field.help,
        "source": field.source,
    }


def about(plugin: Any) -> str:
    """Return what a plug-in's author says of it: the class's docstring."""
    return inspect.cleandoc(plugin.__doc__ or "")


def _describe(screen: Console, outcome: Outcome) -> None:
    listing = outcome.listing
    screen.print(Text(f"{listing.family} {listing.name}", style="bold"))
    details = _details(outcome)
    api = f", API {details['api']}" if details["api"] else ""
    where = details["source"] or listing.target
    screen.print(Text(f"{listing.distribution} {listing.version}{api}", style="dim"))
    screen.print(Text(f"source: {where}", style="dim"), soft_wrap=True)
    if isinstance(outcome, Quarantined):
        screen.print(Text(f"quarantined: {outcome.reason}", style="red"))
        screen.print(Text(outcome.traceback))
        return
    screen.print(Text(details["about"]))
    if isinstance(outcome.plugin, Recipe):
        screen.print(Text(f"steps: {' → '.join(details['steps'])}"))
        for address, values in details["options"].items():
            screen.print(Text(f"sets {address}: {values}"))
        _print_example(screen, details)
        return
    screen.print(Text(f"takes {_either(details['accepts'])}; gives {_either(details['produces'])}"))
    if details["options"]:
        screen.print(_option_table(fields_of(outcome.plugin)))
    _print_example(screen, details)


def _print_example(screen: Console, details: dict[str, Any]) -> None:
    screen.print(Text(f"example: {details['example']}"), soft_wrap=True)


def _either(names: Sequence[str]) -> str:
    return " or ".join(names) or "nothing further"


def _option_table(fields: Sequence[OptionField]) -> Table:
    table = Table("option", "default", "allowed", "what it does", box=None, padding=(0, 2, 0, 0))
    for field in fields:
        source = f" ({field.source})" if field.source else ""
        default = f"{plain(field.default)}".replace("None", "none")
        unit = f" {field.unit}" if field.unit and field.default is not None else ""
        table.add_row(*map(Text, (field.name, f"{default}{unit}", _allowed(field), f"{field.help}{source}")))
    return table


def _allowed(field: OptionField) -> str:
    if field.choices:
        return ", ".join(field.choices)
    bounds = ", ".join(f"{_SIGNS[key]} {value:g}" for key, value in field.bounds.items())
    unit = f" {field.unit}" if field.unit else ""
    return f"{field.type_name}{unit}{' ' + bounds if bounds else ''}"
