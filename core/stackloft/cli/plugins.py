"""``stackloft plugins list`` and ``stackloft plugins show``."""

from __future__ import annotations

import inspect
import json
import sys
from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from stackloft.cli.screen import console
from stackloft.contracts.families import FAMILIES
from stackloft.contracts.recipe import Recipe
from stackloft.model.errors import PluginError
from stackloft.registry.fields import OptionField, fields_of
from stackloft.registry.find import nearest
from stackloft.registry.loading import Loaded, Quarantined, load
from stackloft.registry.options_model import plain
from stackloft.registry.scan import Listing, catalogue

Outcome = Loaded | Quarantined

_COLUMNS = ("family", "name", "distribution", "version", "state")

_SIGNS = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<"}


def show_list(*, as_json: bool) -> None:
    """Print every registered plug-in with its family, distribution, version and state."""
    outcomes = [load(listing) for listing in catalogue()]
    if as_json:
        _print_json([_row(outcome) for outcome in outcomes])
        return
    table = Table(*_COLUMNS, box=None, padding=(0, 2, 0, 0))
    for outcome in outcomes:
        style = "red" if isinstance(outcome, Quarantined) else ""
        table.add_row(*(Text(_row(outcome)[column]) for column in _COLUMNS), style=style)
    screen = console()
    screen.print(table)
    for outcome in outcomes:
        if isinstance(outcome, Quarantined):
            screen.print(Text(f"{outcome.listing.key}: {outcome.reason}", style="red"))


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
    outcomes = [load(listing) for listing in _called(name)]
    if as_json:
        _print_json([_details(outcome) for outcome in outcomes])
        return
    screen = console()
    for number, outcome in enumerate(outcomes):
        if number:
            screen.print()
        _describe(screen, outcome)


def _called(name: str) -> list[Listing]:
    family, dot, rest = name.partition(".")
    within, bare = (family, rest) if dot and family in FAMILIES else (None, name)
    listings = [
        item for item in catalogue() if bare in {item.name, item.qualified} and within in {None, item.family}
    ]
    if not listings:
        names = sorted({item.name for item in catalogue(within)})
        raise PluginError(f"no plug-in is called {name!r}", fix=nearest(bare, names))
    return listings


def _row(outcome: Outcome) -> dict[str, str]:
    listing = outcome.listing
    row = {
        "family": listing.family,
        "name": listing.qualified if listing.clash else listing.name,
        "distribution": listing.distribution,
        "version": listing.version,
        "state": "ok",
        "reason": "",
    }
    if isinstance(outcome, Quarantined):
        return {**row, "state": "quarantined", "reason": outcome.reason}
    return row


def _details(outcome: Outcome) -> dict[str, Any]:
    row: dict[str, Any] = {**_row(outcome), "target": outcome.listing.target}
    if isinstance(outcome, Quarantined):
        return {**row, "traceback": outcome.traceback}
    plugin = outcome.plugin
    if isinstance(plugin, Recipe):
        options = {key: dict(values) for key, values in plugin.options.items()}
        return {**row, "about": plugin.summary, "steps": list(plugin.steps), "options": options}
    return {
        **row,
        "about": about(plugin),
        "accepts": [kind.__name__ for kind in plugin.accepts],
        "produces": [kind.__name__ for kind in plugin.produces],
        "options": [_option(field) for field in fields_of(plugin)],
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
    screen.print(Text(f"{listing.distribution} {listing.version}, {listing.target}", style="dim"))
    details = _details(outcome)
    if isinstance(outcome, Quarantined):
        screen.print(Text(f"quarantined: {outcome.reason}", style="red"))
        screen.print(Text(outcome.traceback))
        return
    screen.print(Text(details["about"]))
    if isinstance(outcome.plugin, Recipe):
        screen.print(Text(f"steps: {' → '.join(details['steps'])}"))
        for address, values in details["options"].items():
            screen.print(Text(f"sets {address}: {values}"))
        return
    screen.print(Text(f"takes {_either(details['accepts'])}; gives {_either(details['produces'])}"))
    if details["options"]:
        screen.print(_option_table(fields_of(outcome.plugin)))


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


def _print_json(value: Any) -> None:
    json.dump(value, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
    sys.stdout.write("\n")
