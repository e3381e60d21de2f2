"""``stackloft plugins check``: the conformance kit of a plug-in's family, run on it."""

from __future__ import annotations

import sys
from dataclasses import asdict

from rich.table import Table
from rich.text import Text

from stackloft.cli.plugin_names import listings_called, print_json
from stackloft.cli.screen import console
from stackloft.model.errors import PluginError, UsageError
from stackloft.registry.child import ask_child
from stackloft.registry.scan import catalogue
from stackloft.testing.conformance.check import NOT_HELD, Finding, findings
from stackloft.testing.conformance.suites import checks_of

LONGEST = 1800.0
"""Seconds that a kit may take."""


def run(name: str, *, as_json: bool) -> bool:
    """Print what each check found and return whether all of them hold.

    The kit runs in a child process, so that a plug-in that crashes is told of and not a crash here.

    Parameters
    ----------
    name : str
        A name, ``family.name``, or ``module:Class`` of a plug-in that need not be installed.
    as_json : bool
        JSON on stdout.

    Raises
    ------
    PluginError
        No such plug-in, one of several families, or one that cannot be imported.
    UsageError
        Its package does not tell what the kit must know.
    """
    subject = _subject(name)
    answer = ask_child("stackloft.cli.plugin_check:examined", subject, LONGEST)
    if answer.fault:
        fix = f"stackloft plugins doctor {subject}" if ":" not in subject else None
        raise PluginError(f"checking {subject} {answer.fault}", found=answer.stderr[-500:] or None, fix=fix)
    if "refusal" in answer.value:
        error = UsageError if answer.value["usage"] else PluginError
        raise error(answer.value["refusal"])
    found = [Finding(**item) for item in answer.value["findings"]]
    passed = all(item.passed for item in found)
    if as_json:
        print_json({"plugin": subject, "passed": passed, "checks": [asdict(item) for item in found]})
    else:
        _print(subject, found)
    return passed


def examined(subject: str) -> dict[str, object]:
    """Run the kit in this process; return findings, or the refusal, as JSON holds them."""
    try:
        checks = checks_of(subject)
    except (PluginError, UsageError) as error:
        return {"refusal": str(error), "usage": isinstance(error, UsageError)}
    return {"findings": [asdict(item) for item in findings(checks)]}


def _subject(name: str) -> str:
    """Return ``family.name`` of what a person named; ``module:Class`` stays as it is."""
    colon = ":" in name
    known = any(item.qualified == name.rpartition(".")[2] for item in catalogue()) if colon else True
    if colon and not known:
        return name
    listings = listings_called(name)
    keys = [listing.key for listing in listings]
    if len(keys) > 1:
        raise PluginError(f"{len(keys)} plug-ins are called {name!r}", fix=f"name one: {', '.join(keys)}")
    return keys[0]


def _outcome(item: Finding) -> str:
    if not item.passed:
        return "FAILS"
    if item.reason.startswith(NOT_HELD):
        return "not posed"
    return "expected failure" if item.reason else "holds"


def _print(subject: str, found: list[Finding]) -> None:
    table = Table("check", "outcome", "reason", box=None, padding=(0, 2, 0, 0))
    for item in found:
        outcome = _outcome(item)
        table.add_row(*map(Text, (item.check, outcome, item.reason)), style="" if item.passed else "red")
    console().print(table)
    broken = sum(not item.passed for item in found)
    sys.stdout.write(f"\n{subject}: {len(found) - broken} of {len(found)} checks hold\n")
