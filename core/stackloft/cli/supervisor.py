"""Commands that meet strangers' plug-ins run in a child process, so that a crash is an answer.

Only when another distribution has registered plug-ins: with the built-in ones alone, nothing of this happens.
The child is a fork made before anything heavy is imported, so it costs some milliseconds. It notes which
plug-in is in control (`stackloft.registry.work_notes`). When it dies, its notes name the culprit:

=========================================  ==============================================================
it died while                              then
=========================================  ==============================================================
importing, or probing a source             the plug-in is set aside, one line says so, the command starts
                                           again: nobody may have asked for that plug-in
reconstructing, meshing, integrating       likewise: a method that needs it is refused by name, and under
                                           ``--method all`` the others are measured
reading, segmenting, writing               the command ends with a message: another reader in its place
                                           would give other figures
=========================================  ==============================================================
"""

from __future__ import annotations

import os
import signal
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from typing import BinaryIO, TypeVar

import typer

from stackloft.model.errors import PluginError
from stackloft.registry import Listing, catalogue
from stackloft.registry.child import how_it_ended
from stackloft.registry.last_words import LastWords, last_words
from stackloft.registry.loading import set_aside
from stackloft.registry.work_notes import keep_notes, note

R = TypeVar("R")

OWN = "stackloft"
REPLACEABLE = frozenset({"import", "probe", "reconstruct", "mesh", "integrate"})
"""What may be left undone without changing what the other plug-ins find."""
_WANTED = frozenset({signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE})
"""Signals by which people and shells end a process."""


def supervise(command: Callable[[], R]) -> R:
    """Call `command`, in a child process when strangers' plug-ins may take part in it.

    Raises
    ------
    PluginError
        A plug-in crashed the child; plug-in and distribution are named.
    Exit
        The child has done the command's work and left.
    """
    if not hasattr(os, "fork") or all(listing.distribution == OWN for listing in catalogue()):
        return command()
    aside: set[Listing] = set()
    while True:
        notes = tempfile.TemporaryFile()  # noqa: SIM115 - the child keeps it open until it is gone
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if child == 0:
            return _working(command, notes)
        status = _watched(child)
        with notes:
            notes.seek(0)
            words = last_words(notes.read().decode(errors="replace"))
        _answer(status, words, aside)


def _working(command: Callable[[], R], notes: BinaryIO) -> R:
    """Run `command` in the child; note with which status it is going to leave."""
    keep_notes(notes)
    status = 1
    try:
        result = command()
        status = 0
    except BaseException as error:
        status = getattr(error, "exit_status", getattr(error, "exit_code", 1))
        raise
    finally:
        with suppress(OSError):
            sys.stdout.flush()
        note("done", status)
    return result


def _watched(child: int) -> int:
    """Wait for the child, handing on what is sent to this process alone; return its wait status.

    The terminal's Ctrl-C reaches both, so SIGINT is only waited out here.
    """

    def hand_on(number: int, _: object) -> None:
        with suppress(ProcessLookupError):
            os.kill(child, number)

    before = {
        signal.SIGINT: signal.signal(signal.SIGINT, signal.SIG_IGN),
        signal.SIGTERM: signal.signal(signal.SIGTERM, hand_on),
        signal.SIGHUP: signal.signal(signal.SIGHUP, hand_on),
    }
    try:
        return os.waitpid(child, 0)[1]
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _answer(wait_status: int, words: LastWords, aside: set[Listing]) -> None:
    """Leave as the child did; or, when a plug-in has ended it, raise or set that one aside."""
    status = os.waitstatus_to_exitcode(wait_status)
    if words.done is not None:
        raise typer.Exit(status if status >= 0 else words.done)
    for part in words.parts:
        part.unlink(missing_ok=True)
    if -status in _WANTED:
        signal.signal(-status, signal.SIG_DFL)
        os.kill(os.getpid(), -status)
    error = _crash(status, words)
    listing, doing = words.suspects[0] if words.suspects else (None, "")
    if listing is None or doing not in REPLACEABLE or listing in aside:
        raise error
    aside.add(listing)
    set_aside(listing, f"{doing} {how_it_ended(status)}")
    if doing in {"import", "probe"}:
        print(f"stackloft: {error.what}; it is left out", file=sys.stderr)  # noqa: T201


def _crash(status: int, words: LastWords) -> PluginError:
    ended = how_it_ended(status)
    if not words.suspects:
        return PluginError(f"stackloft itself {ended}", fix="report it to the authors of stackloft")
    (listing, doing), *others = words.suspects
    maybe = "" if not others else "; or ".join(["", *(f"{x.key} of {x.distribution}" for x, _ in others)])
    return PluginError(
        f"plug-in {listing.family}.{listing.name} of {listing.distribution} {listing.version} {ended}"
        f" in {doing}{maybe}",
        fix=f"stackloft plugins doctor {listing.key}; report it to the authors of {listing.distribution}",
    )
