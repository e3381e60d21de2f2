"""``stackloft plugins list``: what is registered, told from metadata and source text without an import."""

from __future__ import annotations

from rich.table import Table
from rich.text import Text

from stackloft.cli.plugin_names import print_json
from stackloft.cli.screen import console
from stackloft.registry.glance import Glance, glance
from stackloft.registry.scan import catalogue

COLUMNS = ("family", "name", "version", "distribution", "api", "state")

_STYLES = {"ok": "", "newer": "yellow"}


def show_list(*, as_json: bool) -> None:
    """Print every registered plug-in with its family, version, distribution, API version and state."""
    seen = [glance(listing) for listing in catalogue()]
    if as_json:
        print_json([row(found) for found in seen])
        return
    table = Table(*COLUMNS, box=None, padding=(0, 2, 0, 0))
    for found in seen:
        cells = row(found)
        table.add_row(*(Text(cells[column] or "?") for column in COLUMNS), style=_style(found))
    screen = console()
    screen.print(table)
    for found in seen:
        if found.reason:
            told = f"{found.listing.key} of {found.listing.distribution}: {found.state}: {found.reason}"
            screen.print(Text(told, style=_style(found)), soft_wrap=True)
    if any(_style(found) == "red" for found in seen):
        screen.print(Text("`stackloft plugins doctor` loads each one and says what to do"))


def row(found: Glance) -> dict[str, str | None]:
    """Return one plug-in's line; ``api`` is None where only an import could tell."""
    listing = found.listing
    return {
        "family": listing.family,
        "name": listing.qualified if listing.clash else listing.name,
        "version": listing.version,
        "distribution": listing.distribution,
        "api": found.api,
        "state": found.state,
        "reason": found.reason,
        "target": listing.target,
    }


def _style(found: Glance) -> str:
    return _STYLES.get(found.state, "red")
