"""What a process left behind that did not end well: whose work it died of, and its half-written files."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stackloft.registry.scan import Listing, catalogue

_CURRENT = re.compile(r"^Current thread 0x([0-9a-f]+)", re.MULTILINE)
"""How `faulthandler` names the thread that crashed."""


@dataclass(frozen=True, slots=True)
class LastWords:
    """The notes of `stackloft.registry.work_notes`, read after the process is gone."""

    done: int | None = None
    """The exit status it was going to leave with; None: a plug-in or the host died before."""
    suspects: tuple[tuple[Listing, str], ...] = ()
    """Who was in control, and of what; the first is the one that crashed, when that could be told."""
    parts: tuple[Path, ...] = ()
    """Half-written files."""


def last_words(text: str) -> LastWords:
    r"""Return what the notes in `text` come to.

    Examples
    --------
    >>> last_words('["part", "a.part"]\n["gone", "a.part"]\n["done", 0]\n')
    LastWords(done=0, suspects=(), parts=())
    """
    notes = [_parsed(line) for line in text.splitlines() if line.startswith("[")]
    working: dict[int, list[tuple[Listing, str]]] = {}
    done, parts = None, dict.fromkeys(Path(word[1]) for word in notes if word[:1] == ["part"])
    for kind, *words in filter(None, notes):
        if kind == "begin":
            working.setdefault(words[0], []).append(_named(words[1:]))
        elif kind == "end" and working.get(words[0]):
            working[words[0]].pop()
        elif kind == "gone":
            parts.pop(Path(words[0]), None)
        elif kind == "done":
            done = int(words[0])
    return LastWords(done, tuple(_by_guilt(working, text)), tuple(parts))


def _parsed(line: str) -> list[Any]:
    try:
        words: list[Any] = json.loads(line)
    except ValueError:  # cut short by the crash, or part of a traceback
        return []
    return words


def _named(words: Sequence[str]) -> tuple[Listing, str]:
    family, distribution, name, doing = words
    known = (x for x in catalogue(family) if (x.distribution, x.name) == (distribution, name))
    return next(known, Listing(family, name, distribution, "", "")), doing


def _by_guilt(working: dict[int, list[tuple[Listing, str]]], text: str) -> list[tuple[Listing, str]]:
    """Return who was innermost in each thread; the crashed thread alone when `faulthandler` named it."""
    innermost = {thread: stack[-1] for thread, stack in working.items() if stack}
    crashed = _CURRENT.findall(text)
    thread = int(crashed[-1], 16) if crashed else None
    if thread in innermost:
        return [innermost[thread]]
    return sorted(innermost.values(), key=lambda one: one[0].distribution == "stackloft")
