"""Loading one plug-in; a broken one is quarantined with its reason and never breaks the host."""

from __future__ import annotations

import importlib
import traceback
from dataclasses import dataclass
from functools import cache
from typing import Any

from stackloft.model.errors import PluginError
from stackloft.model.notices import Notice
from stackloft.registry.member_checks import faults_of, minor_api_notice
from stackloft.registry.scan import Listing, scan
from stackloft.registry.work_notes import at_work


@dataclass(frozen=True, slots=True)
class Loaded:
    """A plug-in that came through its checks."""

    listing: Listing
    plugin: Any
    """The plug-in class; for a recipe the `Recipe` itself."""
    notices: tuple[Notice, ...] = ()

    @property
    def family(self) -> str:
        """Its family."""
        return self.listing.family

    @property
    def name(self) -> str:
        """Its name."""
        return self.listing.name

    @property
    def key(self) -> str:
        """``family.name``: how options address it."""
        return self.listing.key


@dataclass(frozen=True, slots=True)
class Quarantined:
    """A plug-in that cannot be used, and why."""

    listing: Listing
    reason: str
    """One sentence."""
    traceback: str = ""
    """The whole traceback when loading raised; empty otherwise."""

    def error(self) -> PluginError:
        """Return the error a person sees when this plug-in is asked for by name."""
        return PluginError(
            f"plug-in {self.listing.family}.{self.listing.name} of {self.listing.distribution} "
            f"{self.listing.version} is quarantined",
            found=self.reason,
            fix=f"stackloft plugins show {self.listing.qualified}; update or uninstall "
            f"{self.listing.distribution}",
        )


@cache
def load(listing: Listing) -> Loaded | Quarantined:
    """Import one plug-in and check it; whatever goes wrong is returned, not raised.

    The outcome is remembered, so a broken plug-in is imported once per process.

    Examples
    --------
    >>> load(Listing("reader", "ghost", "acme", "1", "acme_ghost:Reader")).reason
    "ModuleNotFoundError: No module named 'acme_ghost'"
    """
    if listing in _ASIDE:
        return Quarantined(listing, _ASIDE[listing])
    try:
        with at_work(listing, "import"):
            plugin = _resolve(listing.target)
            faults = faults_of(listing.family, plugin)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a stranger's module may raise anything
        return Quarantined(listing, f"{type(error).__name__}: {error}", traceback.format_exc())
    if faults:
        return Quarantined(listing, "; ".join(faults))
    return Loaded(listing, plugin, minor_api_notice(listing.key, plugin.api))


_ASIDE: dict[Listing, str] = {}
"""Plug-ins that are not to be loaded, and why."""


def set_aside(listing: Listing, reason: str) -> None:
    """Quarantine a plug-in without loading it: it has crashed a process before."""
    _ASIDE[listing] = reason
    load.cache_clear()


def rescan() -> None:
    """Forget the scan and what was loaded, for a process in which distributions came or went."""
    _ASIDE.clear()
    scan.cache_clear()
    load.cache_clear()


def _resolve(target: str) -> Any:
    module, _, attributes = target.partition(":")
    found: Any = importlib.import_module(module)
    for attribute in filter(None, attributes.split(".")):
        found = getattr(found, attribute)
    return found
