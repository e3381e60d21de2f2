"""Which pictures of a folder are the slices of this run, and whether they can be."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from pathlib import Path

from stackloft.contracts.stack_file import NAME, StackFile
from stackloft.model.errors import InputError, UsageError
from stackloft.model.slice_stack import SectionKind
from stackloft_plugins.readers.picture_decode import PictureHeader
from stackloft_plugins.readers.picture_kinds import SUFFIXES, natural_key
from stackloft_plugins.readers.slice_faces import in_pairs
from stackloft_plugins.readers.what_is_shown import Shown

MIN_SLICES = 2
"""Fewer sections bound no body."""

_PROBED = 8  # files opened to tell whether a folder holds pictures


def between(every: tuple[Path, ...], matched: tuple[int, ...], first: str, last: str) -> tuple[int, ...]:
    """Return the numbers, from 0, of the meant slices between the files `first` and `last`.

    Raises
    ------
    UsageError
        There is no such file, or the last comes before the first.
    """
    names = [path.name for path in every]
    for flag, name in (("first", first), ("last", last)):
        if name and name not in names:
            raise UsageError(
                "no such slice", where=f"reader.{flag}", found=name, expected=f"{names[0]} … {names[-1]}"
            )
    start = names.index(first) if first else 0
    stop = names.index(last) if last else len(names) - 1
    if stop < start:
        raise UsageError("last comes before first", where="reader.last", found=f"{first}, {last}")
    return tuple(number for number in matched if start <= number <= stop)


def sample(paths: Iterable[Path]) -> list[Path]:
    """Return the few files worth opening: those that promise a picture first."""
    ordered = sorted(paths, key=lambda path: (path.suffix.lower() not in SUFFIXES, natural_key(path.name)))
    return list(islice((path for path in ordered if path.is_file()), _PROBED))


def masks(said: StackFile) -> frozenset[str]:
    """Return the names of the files that are masks, no slices."""
    return frozenset(override.mask for override in said.slice.values() if override.mask is not None)


def check_kind(said: StackFile, folder: Path) -> None:
    """Raise InputError when the folder calls its photographs slabs."""
    if said.kind is SectionKind.SLAB:
        raise InputError(
            "photographs do not show slabs",
            where=str(folder / NAME),
            found='kind = "slab"',
            expected='kind = "face" or "silhouette"',
        )


def check_count(headers: tuple[PictureHeader, ...], path: Path) -> None:
    """Raise InputError for fewer pictures than bound a body."""
    if len(headers) < MIN_SLICES:
        raise InputError(
            "one slice makes no body" if headers else "every slice is skipped",
            where=str(path),
            found=headers[0].path.name if headers else "none",
            expected="at least 2 pictures, better 7 or more",
        )


def paired(
    every: tuple[Path, ...], matched: tuple[int, ...], shown: Shown
) -> tuple[tuple[Path, ...], tuple[int, ...]]:
    """Return the pictures with upper faces before lower ones, and the numbers of those that are meant."""
    ordered = in_pairs(every, shown)
    if ordered == every:
        return every, matched
    meant = {every[number] for number in matched}
    return ordered, tuple(number for number, path in enumerate(ordered) if path in meant)
