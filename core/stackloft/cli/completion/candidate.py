"""What may come next."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Candidate:
    """One word that may stand at the cursor."""

    word: str
    about: str = ""
    """One line on what it is."""
    open: bool = False
    """More must follow in the same word: no space after it."""


FILES: tuple[Candidate, ...] | None = None
"""In place of candidates: the shell's own files and folders."""


def plain(words: Iterable[str], about: str = "") -> tuple[Candidate, ...]:
    """Return words as candidates; those that end in ``:`` or ``=`` want something more."""
    return tuple(Candidate(word, about, word.endswith((":", "=", "."))) for word in words)


def listed(candidates: Sequence[Candidate], current: str) -> tuple[Candidate, ...]:
    """Return candidates for the last of several names with commas between them.

    Examples
    --------
    >>> [found.word for found in listed(plain(["loft", "voxel"]), "loft,")]
    ['loft,voxel']
    """
    before, comma, _ = current.rpartition(",")
    taken = set(before.split(","))
    return tuple(
        Candidate(before + comma + item.word, item.about, item.open)
        for item in candidates
        if item.word not in taken
    )
