"""The answer to a shell that asks what may come next.

A shell sets ``_STACKLOFT_COMPLETE`` to its own name and ``_STACKLOFT_LINE`` to the line up to the cursor, and
runs the command without arguments. The first line of the answer is ``files`` (complete files yourself) or
``words``; then comes one candidate a line, ``word<TAB>what it is``, with a third field ``open`` when no space
belongs after it. Bash takes words for shorter than they are: it is given what is left of them.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from stackloft.cli.completion.candidate import Candidate
from stackloft.cli.completion.line import Line, split_line
from stackloft.cli.completion.values import Candidates, values_of

ASKS = "_STACKLOFT_COMPLETE"
HELP = ("-h", "--help")


def answer(environment: Mapping[str, str]) -> None:
    """Print what may come next."""
    from typer.main import get_command  # noqa: PLC0415 - the command's main imports no Typer

    from stackloft.cli.app import app  # noqa: PLC0415

    line = split_line(environment.get("_STACKLOFT_LINE", ""))
    found = candidates(get_command(app), line)
    broken = environment.get("_STACKLOFT_BREAKS", "") if environment[ASKS] == "bash" else ""
    sys.stdout.write("\n".join(_lines(found, line, broken)) + "\n")


def candidates(root: Any, line: Line) -> Candidates:
    """Return what may stand at the cursor, of that kind which the words before it call for.

    Parameters
    ----------
    root : object
        The command line library's whole command.
    line : Line
    """
    command, names, waiting, given, flags = root, [], None, 0, True
    for word in line.words[1:]:
        parameter = None if waiting else _flag(command, word.partition("=")[0]) if flags else None
        if waiting is not None:
            waiting = None
        elif word == "--" and flags:
            flags = False
        elif parameter is not None:
            waiting = parameter if not parameter.is_flag and "=" not in word else None
        elif flags and word.startswith("-"):
            continue
        elif word in getattr(command, "commands", {}):
            command, given = command.commands[word], 0
            names.append(word)
        else:
            given += 1
    found = _at_cursor(command, " ".join(names), waiting, given, line, flags=flags)
    return found if found is None else tuple(x for x in found if x.word.startswith(line.current))


def _at_cursor(command: Any, name: str, waiting: Any, given: int, line: Line, *, flags: bool) -> Candidates:
    if waiting is not None:
        return values_of(name, waiting, line.current)
    flag, equals, value = line.current.partition("=")
    if flags and equals and (parameter := _flag(command, flag)) is not None:
        found = values_of(name, parameter, value)
        return found and tuple(Candidate(f"{flag}={x.word}", x.about, x.open) for x in found)
    if flags and line.current.startswith("-"):
        return tuple(_flags(command, line))
    if hasattr(command, "commands"):
        return tuple(Candidate(key, _first(item.help)) for key, item in command.commands.items())
    arguments = [x for x in command.params if x.param_type_name == "argument"]
    if given < len(arguments) or (arguments and arguments[-1].nargs == -1):
        return values_of(name, arguments[min(given, len(arguments) - 1)], line.current)
    return tuple(_flags(command, line))


def _flag(command: Any, word: str) -> Any:
    options = (x for x in command.params if x.param_type_name == "option")
    return next((x for x in options if word in {*x.opts, *x.secondary_opts}), None)


def _flags(command: Any, line: Line) -> Iterator[Candidate]:
    """Yield the flags that may still be given: a flag once, unless it may be repeated."""
    used = {word.partition("=")[0] for word in line.words}
    for item in command.params:
        if item.param_type_name == "option" and not item.hidden:
            names = [*item.opts, *item.secondary_opts]
            if item.multiple or not used & set(names):
                yield from (Candidate(flag, _first(item.help)) for flag in names)
    yield Candidate(HELP[1], "Show this message and exit.")


def _first(text: str | None) -> str:
    """Return the first sentence of a help text."""
    return " ".join((text or "").split("\n\n")[0].split())


def _lines(found: Candidates, line: Line, broken: str) -> Sequence[str]:
    if found is None:
        return ["files"]
    cut = max((line.current.rfind(mark) + 1 for mark in broken if mark in ":="), default=0)
    quoted = line.raw != line.current  # inside quotes bash breaks nothing
    rows = [
        "\t".join((x.word[0 if quoted else cut :], x.about, *(["open"] if x.open else []))) for x in found
    ]
    return ["words", *rows]
