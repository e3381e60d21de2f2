"""Warnings that travel with a result."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Notice:
    """Something a person should know about a figure; never silently dropped."""

    code: str
    """Short stable name, for example ``end-guessed``; scripts test it."""
    message: str
    """One sentence with the file or option, the figure that raised it, and what to do."""
