"""Slices that ``stack.toml`` leaves out."""

from __future__ import annotations

from pathlib import Path

from stackloft.contracts.stack_file import NAME, StackFile
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice


def without_skipped(
    numbers: tuple[int, ...], said: StackFile, every: tuple[Path, ...]
) -> tuple[tuple[int, ...], tuple[Notice, ...]]:
    """Return the slices that are used, and a notice that names the skipped ones."""
    beyond = [number for number in said.slice if number > len(every)]
    if beyond:
        raise InputError(
            f"there is no slice {beyond[0]}",
            where=str(every[0].parent / NAME),
            found=f"[slice.{beyond[0]}]",
            expected=f"1 to {len(every)}, counted in natural order",
        )
    skipped = [number for number in numbers if number + 1 in said.slice and said.slice[number + 1].skip]
    kept = tuple(number for number in numbers if number not in skipped)
    if not skipped:
        return kept, ()
    names = ", ".join(every[number].name for number in skipped)
    message = f"skipped as {NAME} says: {names}; the body is interpolated across the gap"
    return kept, (Notice("slice-skipped", message),)
