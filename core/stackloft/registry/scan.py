"""One scan of the installed distributions for plug-ins; imports nothing of theirs."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib.metadata import Distribution, EntryPoint, distributions

from stackloft.contracts.families import FAMILIES
from stackloft.model.errors import PluginError


@dataclass(frozen=True, slots=True)
class Listing:
    """One registered plug-in, as its distribution announces it.

    Examples
    --------
    >>> Listing("reader", "acme", "acme-xct", "1.2", "acme_xct:Reader").qualified
    'acme-xct:acme'
    """

    family: str
    """One of `stackloft.contracts.families.FAMILIES`."""
    name: str
    distribution: str
    version: str
    """Version of the distribution."""
    target: str
    """``module:attribute``"""
    clash: tuple[str, ...] = ()
    """Other distributions that register the same name in the same family."""

    @property
    def qualified(self) -> str:
        """``distribution:name``, which no clash makes ambiguous."""
        return f"{self.distribution}:{self.name}"

    @property
    def key(self) -> str:
        """``family.name`` (``family.distribution:name`` on a clash): how options address it."""
        return f"{self.family}.{self.qualified if self.clash else self.name}"


def catalogue(family: str | None = None) -> tuple[Listing, ...]:
    """Return every registered plug-in (of `family`), by family, name and distribution.

    Reads the metadata of the installed distributions once per process and imports nothing.

    Raises
    ------
    PluginError
        No such family.

    Examples
    --------
    >>> [listing.name for listing in catalogue("segmenter") if listing.distribution == "stackloft"]
    ['colour', 'histogram']
    """
    if family is None:
        return scan()
    if family not in FAMILIES:
        raise PluginError("no such plug-in family", found=family, expected=", ".join(FAMILIES))
    return tuple(listing for listing in scan() if listing.family == family)


@cache
def scan() -> tuple[Listing, ...]:
    """Return every registered plug-in; see `catalogue`, which answers questions about them."""
    found = [_listing(entry, dist) for dist in _shadowing_first() for entry in _ours(dist)]
    holders: dict[tuple[str, str], list[str]] = {}
    for listing in found:
        holders.setdefault((listing.family, listing.name), []).append(listing.distribution)
    marked = [_with_clash(listing, holders[listing.family, listing.name]) for listing in found]
    return tuple(sorted(marked, key=lambda x: (FAMILIES.index(x.family), x.name, x.distribution)))


def _shadowing_first() -> list[Distribution]:
    """Return one distribution per name: the first on the path hides the others, as for imports."""
    first: dict[str, Distribution] = {}
    for dist in distributions():
        name = dist.metadata["Name"]
        if name:
            first.setdefault(re.sub(r"[-_.]+", "-", name).lower(), dist)
    return list(first.values())


def _ours(dist: Distribution) -> list[EntryPoint]:
    return [entry for entry in dist.entry_points if _family_of(entry.group) is not None]


def _family_of(group: str) -> str | None:
    package, _, plural = group.partition(".")
    family = plural.removesuffix("s")
    return family if package == "stackloft" and plural == f"{family}s" and family in FAMILIES else None


def _listing(entry: EntryPoint, dist: Distribution) -> Listing:
    family = _family_of(entry.group) or ""
    return Listing(family, entry.name, dist.metadata["Name"], dist.version, entry.value)


def _with_clash(listing: Listing, holders: list[str]) -> Listing:
    others = tuple(sorted(name for name in holders if name != listing.distribution))
    return Listing(
        listing.family, listing.name, listing.distribution, listing.version, listing.target, others
    )
