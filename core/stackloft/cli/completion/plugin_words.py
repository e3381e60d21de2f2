"""Names of plug-ins and their options, from metadata and source text: no plug-in is imported."""

from __future__ import annotations

from collections.abc import Iterable

from stackloft.cli.completion.candidate import Candidate
from stackloft.contracts.families import FAMILIES
from stackloft.registry.glimpse import GlimpsedOption, glimpse_options
from stackloft.registry.scan import Listing, catalogue


def names(family: str) -> tuple[Candidate, ...]:
    """Return the plug-ins of a family as flags name them."""
    return tuple(Candidate(_name(listing), _about(listing)) for listing in catalogue(family))


def every_name() -> tuple[Candidate, ...]:
    """Return every plug-in by its name, and by ``family.name`` where two share one."""
    found: dict[str, list[str]] = {}
    for listing in catalogue():
        found.setdefault(_name(listing), []).append(listing.family)
    shared = [listing for listing in catalogue() if len(found[_name(listing)]) > 1]
    return (
        *(Candidate(name, " and ".join(families)) for name, families in found.items()),
        *(Candidate(listing.key, _about(listing)) for listing in shared),
    )


def settings(current: str) -> tuple[Candidate, ...]:
    """Return what may follow ``--set``: an address, then its options, then a value.

    Examples
    --------
    >>> [found.word for found in settings("integrator.cavalieri.")]
    ['integrator.cavalieri.rule=']
    """
    address, equals, _ = current.partition("=")
    key, dot, option = address.rpartition(".")
    if equals:
        return tuple(_values(address, [x for x in _options(key) if x.name == option.replace("-", "_")]))
    if not dot:
        return _addresses()
    within = [listing for listing in catalogue(key) if _options(listing.key)] if key in FAMILIES else []
    deeper = [Candidate(f"{key}.{_name(listing)}.", _about(listing), True) for listing in within]
    return (*(Candidate(f"{key}.{x.name}=", x.help, True) for x in _options(key)), *deeper)


def _addresses() -> tuple[Candidate, ...]:
    having = [listing for listing in catalogue() if listing.family != "recipe" and _options(listing.key)]
    families = dict.fromkeys(listing.family for listing in having)
    plugins = {_name(listing): listing for listing in having}
    return (
        *(Candidate(f"{family}.", f"whichever {family} runs", True) for family in families),
        *(Candidate(f"{name}.", _about(listing), True) for name, listing in plugins.items()),
    )


def _options(key: str) -> list[GlimpsedOption]:
    """Return the options that ``family``, ``name`` or ``family.name`` may have, each once."""
    meant = [
        x for x in catalogue() if key in {x.family, x.name, x.qualified, x.key, f"{x.family}.{x.qualified}"}
    ]
    found: dict[str, GlimpsedOption] = {}
    for listing in meant:
        for option in glimpse_options(listing):
            known = found.get(option.name, option)
            choices = tuple(dict.fromkeys([*known.choices, *option.choices]))
            found[option.name] = GlimpsedOption(option.name, known.help or option.help, choices)
    return list(found.values())


def _values(address: str, options: Iterable[GlimpsedOption]) -> Iterable[Candidate]:
    for option in options:
        for choice in option.choices:
            yield Candidate(f"{address}={choice}")


def _name(listing: Listing) -> str:
    return listing.qualified if listing.clash else listing.name


def _about(listing: Listing) -> str:
    return f"{listing.family} of {listing.distribution}"
