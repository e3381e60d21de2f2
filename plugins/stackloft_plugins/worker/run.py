r"""A function called in a process of its own, watched, and killed when it must be.

::

    parent ──arrays──▶ worker: one function of one crash-prone library
       │  looks 20 times a second: too long? too much memory?
       ◀──arrays──────  or one clear error: crash | time | memory | raised
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from tempfile import TemporaryDirectory, TemporaryFile
from typing import Any

from numpy.typing import NDArray

from stackloft.model.errors import InputError
from stackloft_plugins.worker.limits import Limits, megabytes_of
from stackloft_plugins.worker.message import pack, unpack

_LOOK = 0.05
"""Seconds from one look at the worker to the next."""
_FULL = 0.9
"""A worker that dies with this part of its memory used has died of it."""
_OUT_OF_MEMORY = ("bad_alloc", "MemoryError", "Cannot allocate memory", "out of memory")


class WorkerError(InputError):
    """The worker gave no answer; `kind` is ``crash``, ``time``, ``memory`` or ``raised``."""

    def __init__(self, kind: str, what: str, **details: str | None) -> None:
        self.kind = kind
        super().__init__(what, **details)


@dataclass(frozen=True, slots=True)
class _End:
    status: int
    answer: bytes
    stderr: str
    most: float
    """MB, the most that was seen in use."""
    killed: str = ""
    """``time`` or ``memory`` when the parent ended it."""


def run_alone(
    function: str,
    arrays: Mapping[str, NDArray[Any]],
    values: Mapping[str, Any],
    limits: Limits,
    *,
    what: str,
    fixes: Mapping[str, str] | None = None,
) -> dict[str, NDArray[Any]]:
    """Call ``module:function(arrays, **values)`` in a fresh process and return the arrays it gives.

    Parameters
    ----------
    function : str
        ``module:function``; takes a dict of arrays and keywords, returns a dict of arrays.
    arrays, values : mapping
        What it is given; `values` are JSON's own types.
    limits : Limits
        Time and memory.
    what : str
        Whose work it is, for messages.
    fixes : mapping, optional
        What a person can do, by the error's kind.

    Raises
    ------
    WorkerError
        It crashed, took too long, took too much memory, or raised. This process goes on.

    Examples
    --------
    >>> import numpy as np
    >>> run_alone("builtins:dict", {"a": np.arange(3)}, {}, Limits(60, 500), what="dict")["a"]
    array([0, 1, 2])
    """
    end = _watched(function, pack(arrays, dict(values)), limits)
    kind, found = _fault(end, limits)
    if not kind:
        given, fault = unpack(end.answer)
        if fault is None:
            return given
        kind, found = fault["kind"], fault["words"]
    saying = {
        "crash": f"{what} crashed in its own process; nothing else is harmed",
        "time": f"{what} did not end within {limits.seconds:g} s and was stopped",
        "memory": f"{what} needed more than {limits.megabytes:g} MB and was stopped",
        "raised": f"{what} failed",
    }
    raise WorkerError(kind, saying[kind], found=found, fix=(fixes or {}).get(kind))


def _watched(function: str, message: bytes, limits: Limits) -> _End:
    """Run the worker to its end, which may be this function's doing; files without names carry the talk."""
    command = [sys.executable, "-P", "-m", "stackloft_plugins.worker.child", function]
    command += [repr(limits.seconds), repr(limits.megabytes)]
    places = [os.path.abspath(place) for place in sys.path if place]  # noqa: PTH100 - places may be archives
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(places)}
    with (
        TemporaryDirectory(
            prefix="stackloft-worker-"
        ) as folder,  # where a library may drop files as it likes
        TemporaryFile() as asked,
        TemporaryFile() as answer,
        TemporaryFile() as stderr,
    ):
        asked.write(message)
        asked.seek(0)
        with subprocess.Popen(
            command, stdin=asked, stdout=answer, stderr=stderr, env=environment, cwd=folder
        ) as child:
            try:
                most, killed = _watch(child, limits)
            finally:
                child.kill()
        answer.seek(0)
        stderr.seek(0)
        return _End(child.returncode, answer.read(), stderr.read().decode(errors="replace"), most, killed)


def _watch(child: subprocess.Popen[bytes], limits: Limits) -> tuple[float, str]:
    """Return the most memory seen in use, MB, and why `child` must be ended; empty when it has ended."""
    deadline, most = time.monotonic() + limits.seconds, 0.0
    while True:
        with suppress(subprocess.TimeoutExpired):
            child.wait(_LOOK)
            return most, ""
        most = max(most, megabytes_of(child.pid))
        if most > limits.megabytes:
            return most, "memory"
        if time.monotonic() > deadline:
            return most, "time"


def _fault(end: _End, limits: Limits) -> tuple[str, str]:
    """Return kind and words of what went wrong with the process itself; empty when nothing did."""
    if end.killed:
        return end.killed, f"{end.most:.0f} MB in use" if end.killed == "memory" else ""
    if end.status == 0 and end.answer:
        return "", ""
    last = " ".join(end.stderr.split())[-200:]
    hungry = end.most > _FULL * limits.megabytes or any(word in end.stderr for word in _OUT_OF_MEMORY)
    if hungry:
        return "memory", last or f"{end.most:.0f} MB in use"
    if end.status == -getattr(signal, "SIGKILL", 9):
        return (
            "memory",
            f"the system ended it (SIGKILL) at {end.most:.0f} MB, as it does when memory runs out",
        )
    if end.status < 0:
        return "crash", ": ".join(filter(None, [signal.Signals(-end.status).name, last]))
    return "crash", f"it left with status {end.status}: {last}"
