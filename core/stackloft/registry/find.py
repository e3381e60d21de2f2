"""Finding a plug-in by its name."""

from __future__ import annotations

from difflib import get_close_matches

from stackloft.model.errors import PluginError
from stackloft.registry.loading import Loaded, Quarantined, load
from stackloft.registry.scan import Listing, catalogue


def find(family: str, name: str, *, prefer: str | None = None) -> Loaded:
    """Return the plug-in called `name`, loaded.

    Parameters
    ----------
    family : str
        For example ``reader``.
    name : str
        Its name, or ``distribution:name`` when two distributions use the same one.
    prefer : str, optional
        Distribution that wins a clash: a recipe's steps mean its own distribution's plug-ins. A
        quarantined plug-in always loses one.

    Raises
    ------
    PluginError
        No such name (with the nearest ones), two distributions with that name, or a quarantined plug-in.

    Examples
    --------
    >>> find("recipe", "loft").plugin.steps[-1]
    'integrator.surface-gauss'
    """
    candidates = _candidates(family, name, prefer)
    if len(candidates) > 1:
        healthy = [x for x in map(load, candidates) if isinstance(x, Loaded)]
        if len(healthy) != 1:
            raise _ambiguous(candidates)
        return healthy[0]
    outcome = load(candidates[0])
    if isinstance(outcome, Quarantined):
        raise outcome.error()
    return outcome


def locate(family: str, name: str, *, prefer: str | None = None) -> Listing:
    """Return the listing called `name`, without importing it (errors as for `find`)."""
    candidates = _candidates(family, name, prefer)
    if len(candidates) > 1:
        raise _ambiguous(candidates)
    return candidates[0]


def _candidates(family: str, name: str, prefer: str | None) -> list[Listing]:
    distribution, colon, bare = name.rpartition(":")
    candidates = [x for x in catalogue(family) if x.name == bare]
    if colon:
        candidates = [x for x in candidates if x.distribution == distribution]
    if prefer is not None and len(candidates) > 1:
        candidates = [x for x in candidates if x.distribution == prefer] or candidates
    if not candidates:
        raise _unknown(family, name)
    return candidates


def nearest(word: str, words: list[str]) -> str:
    """Return a hint with the words most like `word`, or with all of them when none is alike.

    Examples
    --------
    >>> nearest("lofft", ["loft", "fem"])
    'did you mean loft?'
    """
    close = get_close_matches(word, words, n=2, cutoff=0.6)
    if close:
        return f"did you mean {' or '.join(close)}?"
    return f"there is {', '.join(words)}" if words else "there is none"


def _ambiguous(candidates: list[Listing]) -> PluginError:
    return PluginError(
        f"several distributions register {candidates[0].family} {candidates[0].name!r}",
        found=", ".join(f"{x.distribution} {x.version}" for x in candidates),
        fix=f"name one in full: {' or '.join(x.qualified for x in candidates)}",
    )


def _unknown(family: str, name: str) -> PluginError:
    names = [x.qualified if ":" in name or x.clash else x.name for x in catalogue(family)]
    return PluginError(f"no {family} is called {name!r}", fix=nearest(name, names))
