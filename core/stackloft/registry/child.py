"""Asking a question in a process of its own, so that a crash there is an answer and not the end.

The answer travels on a copy of stdout that the callee does not know of; what it prints goes to stderr.
"""

from __future__ import annotations

import importlib
import json
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from typing import Any

_COLOURS = re.compile(r"\x1b\[[0-9;]*m")
"""Colours for a terminal."""


@dataclass(frozen=True, slots=True)
class Answer:
    """What came back from the child."""

    value: Any
    """The function's result; None when there is a fault."""
    fault: str = ""
    """Why there is no result, in words: it died of a signal, left, or took too long."""
    stderr: str = ""
    seconds: float = 0.0


def ask_child(function: str, argument: Any = None, timeout: float = 120.0) -> Answer:
    """Call ``module:function`` with one JSON value in a fresh interpreter and return what it answers.

    Parameters
    ----------
    function : str
        ``module:function``; takes one JSON value, returns one.
    argument : object
        The JSON value.
    timeout : float
        Seconds after which the child is killed.

    Examples
    --------
    >>> ask_child("os.path:basename", "a/b").value
    'b'
    >>> ask_child("os:_exit", 3).fault
    'left the process with status 3'
    """
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    command = [sys.executable, "-P", "-m", "stackloft.registry.child", function]
    start = time.perf_counter()
    try:
        done = subprocess.run(
            command,
            input=json.dumps(argument).encode(),
            capture_output=True,
            check=False,
            timeout=timeout,
            env=environment,
        )
    except subprocess.TimeoutExpired:
        return Answer(None, f"did not end within {timeout:g} s", seconds=timeout)
    seconds, stderr = time.perf_counter() - start, _COLOURS.sub("", done.stderr.decode(errors="replace"))
    if done.returncode == 0 and done.stdout:
        return Answer(json.loads(done.stdout), "", stderr, seconds)
    return Answer(None, how_it_ended(done.returncode), stderr, seconds)


def how_it_ended(status: int) -> str:
    """Return a child's exit status (negative: the signal it died of) in words.

    Examples
    --------
    >>> how_it_ended(-11)
    'crashed the process (SIGSEGV)'
    """
    if -status == signal.SIGKILL:
        return "was killed (SIGKILL), as when memory runs out"
    if status < 0:
        return f"crashed the process ({signal.Signals(-status).name})"
    return f"left the process with status {status}"


def _main() -> None:
    """Answer one question: ``python -m stackloft.registry.child module:function`` with JSON on stdin."""
    answer = os.dup(1)
    os.dup2(2, 1)
    module, _, name = sys.argv[1].partition(":")
    value = getattr(importlib.import_module(module), name)(json.loads(sys.stdin.read()))
    with os.fdopen(answer, "wb") as stream:
        stream.write(json.dumps(value).encode())
    sys.stdout.flush()
    os._exit(0)  # a library that crashes while Python shuts down has answered all the same


if __name__ == "__main__":
    _main()
