"""What the ``plugins`` commands share: the names people give, and JSON on stdout."""

from __future__ import annotations

import json
import sys
from typing import Any

from stackloft.contracts.families import FAMILIES
from stackloft.model.errors import PluginError
from stackloft.registry.find import nearest
from stackloft.registry.scan import Listing, catalogue


def listings_called(name: str) -> list[Listing]:
    """Return the plug-ins that `name` may mean; imports none of them.

    Parameters
    ----------
    name : str
        A name, ``family.name``, ``distribution:name`` or ``family.distribution:name``.

    Raises
    ------
    PluginError
        No plug-in has that name; the nearest ones are named.

    Examples
    --------
    >>> [listing.family for listing in listings_called("integrator.cavalieri")]
    ['integrator']
    """
    family, dot, rest = name.partition(".")
    within, bare = (family, rest) if dot and family in FAMILIES else (None, name)
    listings = [
        item for item in catalogue() if bare in {item.name, item.qualified} and within in {None, item.family}
    ]
    if not listings:
        names = sorted({item.name for item in catalogue(within)})
        raise PluginError(f"no plug-in is called {name!r}", fix=nearest(bare, names))
    return listings


def print_json(value: Any) -> None:
    """Print `value` as one JSON document."""
    json.dump(value, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
    sys.stdout.write("\n")
