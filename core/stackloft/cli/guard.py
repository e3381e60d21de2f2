"""What a command says when it cannot go on: one line on stderr and an exit status, never a traceback.

=======  =====================================================
status   when
=======  =====================================================
0        done
1        the input cannot be measured, or a result not written
2        wrong usage
130      interrupted (Ctrl-C)
=======  =====================================================
"""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Callable
from typing import NoReturn, ParamSpec, TypeVar

import typer

from stackloft.model.errors import StackloftError

P = ParamSpec("P")
R = TypeVar("R")


class Supervision:
    """Whether commands are run in a child when strangers' plug-ins are there: by `main`, not by callers."""

    wanted = False


def guarded(command: Callable[P, R]) -> Callable[P, R]:
    """Return `command`, which meets plug-ins, answering for every failure of its own and of theirs.

    An expected failure is one line and an exit status; so is a stranger's plug-in that crashes the process
    (`stackloft.cli.supervisor`).
    """

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        if not Supervision.wanted:
            return command(*args, **kwargs)
        Supervision.wanted = False  # once is enough: a child does its work itself
        from stackloft.cli.supervisor import supervise  # noqa: PLC0415 - help needs no registry

        return supervise(functools.partial(command, *args, **kwargs))

    return answering(run)


def answering(command: Callable[P, R]) -> Callable[P, R]:
    """Return `command` with every expected failure turned into one line and an exit status."""

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            result = command(*args, **kwargs)
            sys.stdout.flush()
        except StackloftError as error:
            _leave(str(error), error.exit_status)
        except KeyboardInterrupt:
            _leave("interrupted; nothing half-written is left behind", 130)
        except MemoryError:
            _leave("not enough memory; give fewer or smaller slices", 1)
        except BrokenPipeError:
            _leave("", 1)
        except OSError as error:
            _leave(_system_refusal(error), 1)
        return result

    return run


def _system_refusal(error: OSError) -> str:
    name = f"{error.filename}: " if error.filename else ""
    return f"{name}{(error.strerror or str(error)).lower()}"


def _leave(message: str, status: int) -> NoReturn:
    """Print `message` on one line of stderr and leave; what stdout could not take is let go."""
    if message:
        print(f"stackloft: {' '.join(message.split())}", file=sys.stderr)  # noqa: T201
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    raise typer.Exit(status)
