"""The doctor's round: plug-ins alone, stale entry points, codecs, system libraries, kernels, rendering."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import asdict

from rich.table import Table
from rich.text import Text

from stackloft.cli.doctor.codecs import transfer_syntaxes
from stackloft.cli.doctor.entry_points import stale_entry_points
from stackloft.cli.doctor.kernels import compiled_kernels
from stackloft.cli.doctor.libraries import packages, system_fix
from stackloft.cli.doctor.rendering import rendering
from stackloft.cli.doctor.row import Row
from stackloft.cli.plugin_names import listings_called, print_json
from stackloft.cli.screen import console
from stackloft.registry.alone import Health, load_each_alone
from stackloft.registry.scan import Listing, catalogue

_STYLES = {"ok": "", "warning": "yellow", "broken": "red"}


def run(names: Sequence[str], *, as_json: bool) -> bool:
    """Print what was found and return whether nothing is broken.

    Parameters
    ----------
    names : sequence of str
        Plug-ins to look at, as for ``plugins show``; none: all of them, and the machine as well.
    as_json : bool
        JSON on stdout.
    """
    rows = examine(names)
    if as_json:
        print_json([asdict(row) for row in rows])
    else:
        _print(rows)
    return all(row.state != "broken" for row in rows)


def examine(names: Sequence[str]) -> list[Row]:
    """Return every row; plug-ins first."""
    if names:
        listings = [listing for name in names for listing in listings_called(name)]
        return [_plugin(health) for health in load_each_alone(tuple(dict.fromkeys(listings)))]
    rows = [_plugin(health) for health in load_each_alone(catalogue())]
    machine = (*packages(), *transfer_syntaxes(), compiled_kernels(), rendering())
    return [*rows, *stale_entry_points(), *machine]


def _plugin(health: Health) -> Row:
    listing = health.listing
    whose = f"{listing.distribution} {listing.version}"
    if health.reason:
        return Row(
            "plug-in", listing.key, "broken", f"{whose}: {health.reason}", _fix(health), health.traceback
        )
    state = "warning" if health.notice or listing.clash else "ok"
    clash = f"also registered by {', '.join(listing.clash)}: name it in full" if listing.clash else ""
    told = "; ".join(filter(None, (health.notice, clash)))
    return Row("plug-in", listing.key, state, f"{whose}{': ' if told else ''}{told}")


def _fix(health: Health) -> str:
    """Return what to do about a plug-in that does not load."""
    listing: Listing = health.listing
    _, system = system_fix(f"{health.reason}\n{health.traceback}")
    if system:
        return system
    if health.reason.startswith("ModuleNotFoundError: No module named "):
        absent = health.reason.rpartition("named ")[2].strip("'").partition(".")[0]
        if absent != listing.target.partition(":")[0].partition(".")[0]:
            return f"python -m pip install {absent}"
    return (
        f"install {listing.distribution} again, update it, or: python -m pip uninstall {listing.distribution}"
    )


def _print(rows: Sequence[Row]) -> None:
    screen = console()
    table = Table("what", "name", "state", "found", box=None, padding=(0, 2, 0, 0))
    for row in rows:
        cells = (row.topic, row.name, row.state, row.detail)
        table.add_row(*map(Text, cells), style=_STYLES[row.state])
    screen.print(table)
    for row in rows:
        if row.state == "ok" or not (row.fix or row.traceback):
            continue
        screen.print(Text(f"\n{row.topic} {row.name}: {row.detail}", style=_STYLES[row.state]))
        if row.traceback:
            screen.print(Text(row.traceback.rstrip()), soft_wrap=True)
        if row.fix:
            screen.print(Text(f"fix: {row.fix}"), soft_wrap=True)
    broken = sum(row.state == "broken" for row in rows)
    sys.stdout.write(f"\n{len(rows)} looked at, {broken} broken\n")
