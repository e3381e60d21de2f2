"""Watching what a call does to the world: files, network, processes, global state."""

from __future__ import annotations

import os
import random
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_ACTIONS = (
    *("os.remove", "os.rename", "os.mkdir", "os.rmdir", "os.chmod", "os.chown", "os.link", "os.symlink"),
    *("os.truncate", "os.utime", "os.system", "os.exec", "os.fork", "os.posix_spawn", "subprocess.Popen"),
    *("socket.connect", "socket.getaddrinfo", "socket.bind", "urllib.Request", "ftplib.connect"),
    *("smtplib.connect", "tempfile.mkstemp", "tempfile.mkdtemp"),
)
_BY_IMPORTS = frozenset({"LD_LIBRARY_PATH", "GDCM_RESOURCES_PATH"})
"""What the mere import of OpenCV and of gdcm sets."""


@dataclass(slots=True)
class Watch:
    """What was seen while a block ran."""

    opened: set[str] = field(default_factory=set)
    """Files opened for reading."""
    deeds: list[str] = field(default_factory=list)
    """Files written, processes started, connections made, global state changed."""
    seconds: float = 0.0


_watches: list[Watch] = []
_hook_lock = threading.Lock()
_hooked = False


@contextmanager
def watching(folder: Path) -> Iterator[Watch]:
    """Record file accesses and side effects of the block, in this process, on any thread.

    Parameters
    ----------
    folder : Path
        Opened files are counted below it; the files there must stay as they are.
    """
    _hook()
    random.random()  # a call that always sets the same seed must show
    np.random.random_sample()  # noqa: NPY002
    watch = Watch()
    before, state = snapshot(folder), _state()
    _watches.append(watch)
    start = time.perf_counter()
    try:
        yield watch
    finally:
        watch.seconds = time.perf_counter() - start
        _watches.remove(watch)
        watch.opened = {name for name in watch.opened if Path(name).is_relative_to(folder)}
        watch.deeds += [f"changes {name}" for name, value in _state().items() if value != state[name]]
        if snapshot(folder) != before:
            watch.deeds.append("changes the source's files")


def snapshot(folder: Path) -> dict[str, tuple[int, int]]:
    """Return size in bytes and modification time in ns of everything below `folder`."""
    items = ((path.relative_to(folder).as_posix(), path.stat()) for path in folder.rglob("*"))
    return {name: (stat.st_size, stat.st_mtime_ns) for name, stat in items}


def _state() -> dict[str, Any]:
    """Return global state that a plug-in has no business changing."""
    return {
        "the working directory": os.getcwd(),  # noqa: PTH109 - the bare text is compared
        "the environment": {name: value for name, value in os.environ.items() if name not in _BY_IMPORTS},
        "the import path": tuple(sys.path),
        "numpy's error handling": np.geterr(),
        "numpy's global random state": np.random.get_state()[1].tobytes(),  # type: ignore[index]  # noqa: NPY002
        "Python's global random state": random.getstate(),
    }


def _hook() -> None:
    """Install the audit hook once; Python offers no way to take one out again."""
    global _hooked  # noqa: PLW0603 - one hook per process
    with _hook_lock:
        if not _hooked:
            sys.addaudithook(_audit)
            _hooked = True


def _audit(event: str, arguments: tuple[Any, ...]) -> None:
    if not _watches:
        return
    deed = None
    if event == "open" and isinstance(arguments[0], (str, bytes, os.PathLike)):
        name, flags = os.fsdecode(arguments[0]), arguments[2] or 0
        if flags & _WRITING and "__pycache__" not in name and name != os.devnull:
            deed = f"writes {name}"
        elif not flags & _WRITING:
            for watch in _watches:
                watch.opened.add(name)
    elif event in _ACTIONS:
        deed = f"{event} {arguments[0] if arguments else ''}".strip()
    if deed and "__pycache__" not in deed:
        for watch in _watches:
            watch.deeds.append(deed)
