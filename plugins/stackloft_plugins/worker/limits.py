"""What a worker may use, and how it is kept to it.

The parent looks at the worker's memory and clock many times a second and kills it; the system itself refuses
one huge allocation (RLIMIT_DATA) and ends a worker whose parent is gone (RLIMIT_CPU, and on Linux at once).
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

_HEADROOM = 512
"""MB above the limit at which the system itself refuses: libraries' code and thread stacks count there."""
_PARENT_DEATH_SIGNAL = 1
"""``PR_SET_PDEATHSIG`` of Linux's prctl."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Time and memory for one call."""

    seconds: float
    megabytes: float


def keep_to(limits: Limits) -> None:
    """Ask the system to hold this process to `limits`, as far as the system can."""
    try:
        import resource  # noqa: PLC0415 - not on Windows
    except ImportError:
        return
    size = int((limits.megabytes + _HEADROOM) * 2**20)
    seconds = int(limits.seconds * (os.cpu_count() or 1)) + 60
    for kind, value in (
        (resource.RLIMIT_DATA, size),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_CORE, 0),
    ):
        hard = resource.getrlimit(kind)[1]
        allowed = value if hard == resource.RLIM_INFINITY else min(value, hard)
        with suppress(ValueError, OSError):
            resource.setrlimit(kind, (allowed, hard))
    if sys.platform == "linux":
        import ctypes  # noqa: PLC0415 - for this alone

        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_PARENT_DEATH_SIGNAL, signal.SIGKILL)


def megabytes_of(pid: int) -> float:
    """Return the memory that process `pid` has in use, MB; 0 where the system does not tell.

    Examples
    --------
    >>> megabytes_of(-1)
    0.0
    """
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 2**20
    except (OSError, ValueError, IndexError):
        return 0.0
