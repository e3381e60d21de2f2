"""One line of the doctor's report."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Row:
    """One thing that was looked at."""

    topic: str
    """``plug-in``, ``entry point``, ``transfer syntax``, ``package``, ``kernels``, ``rendering``"""
    name: str
    state: str
    """``ok``, ``warning`` (works, or is optional) or ``broken``"""
    detail: str = ""
    fix: str = ""
    """What to type, where something can be done."""
    traceback: str = ""
