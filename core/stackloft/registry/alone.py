"""Loading one plug-in in a process of its own: a hard crash there cannot take the host with it."""

from __future__ import annotations

import tempfile
import traceback
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from stackloft.registry.child import ask_child
from stackloft.registry.loading import Quarantined, load
from stackloft.registry.scan import Listing

LONGEST = 120.0
"""Seconds that loading one plug-in may take."""


@dataclass(frozen=True, slots=True)
class Health:
    """What became of one plug-in when it was loaded alone."""

    listing: Listing
    reason: str = ""
    """Why it cannot be used; empty when it can."""
    traceback: str = ""
    notice: str = ""
    """What should be known of it although it can be used."""
    seconds: float = 0.0


def load_each_alone(listings: Sequence[Listing], workers: int = 2) -> tuple[Health, ...]:
    """Load each plug-in in a child process of its own, with its defaults; readers probe an empty folder.

    Parameters
    ----------
    listings : sequence of Listing
    workers : int
        Children at the same time.
    """
    with ThreadPoolExecutor(workers) as pool:
        return tuple(pool.map(_load_alone, listings))


def _load_alone(listing: Listing) -> Health:
    answer = ask_child("stackloft.registry.alone:report", asdict(listing), LONGEST)
    if answer.fault:
        return Health(listing, f"loading it {answer.fault}", answer.stderr[-2000:], seconds=answer.seconds)
    reason, trace, notice = answer.value
    return Health(listing, reason, trace, notice, answer.seconds)


def report(said: dict[str, Any]) -> tuple[str, str, str]:
    """Load the plug-in of a listing in this process; return reason, traceback and notice as text.

    Examples
    --------
    >>> listing = Listing("reader", "ghost", "acme", "1", "acme_ghost:Reader")
    >>> report(asdict(listing))[0]
    "ModuleNotFoundError: No module named 'acme_ghost'"
    """
    outcome = load(Listing(**{**said, "clash": tuple(said["clash"])}))
    if isinstance(outcome, Quarantined):
        return outcome.reason, outcome.traceback, ""
    try:
        if outcome.family != "recipe":
            instance = outcome.plugin()
            if outcome.family == "reader":
                with tempfile.TemporaryDirectory() as folder:
                    float(instance.probe(Path(folder)))
    except Exception as error:  # noqa: BLE001 - a stranger's plug-in may raise anything
        return f"built with its defaults: {type(error).__name__}: {error}", traceback.format_exc(), ""
    return "", "", "; ".join(notice.message for notice in outcome.notices)
