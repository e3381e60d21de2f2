"""Where the sections lie and how large a pixel is: flags first, then ``stack.toml``, never a guess."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from stackloft.contracts.stack_file import NAME, StackFile
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError, UsageError
from stackloft.model.lengths import parse_length, parse_lengths
from stackloft_plugins.readers.slice_faces import face_steps
from stackloft_plugins.readers.what_is_shown import Shown


@dataclass(frozen=True, slots=True)
class SpacingOptions:
    """What the flags say; text or millimetres, None when not given."""

    pixel_size: float | str | None = None
    thickness: float | str | None = None
    positions: tuple[float, ...] | str | None = None
    kerf: float | str | None = None


def pixel_size_of(flags: SpacingOptions, said: StackFile, where: Path) -> tuple[float, str]:
    """Return the pixel size in mm and who said it.

    Raises
    ------
    UsageError
        The flag is no positive length.
    InputError
        Nobody said it.

    Examples
    --------
    >>> pixel_size_of(SpacingOptions(pixel_size="0.03cm"), StackFile(), Path("apple"))
    (0.3, '--pixel-size')
    """
    if flags.pixel_size is not None:
        return _positive(flags.pixel_size, "--pixel-size"), "--pixel-size"
    if said.pixel_size is not None:
        return said.pixel_size, NAME
    raise InputError(
        "pixel size is unknown",
        where=str(where),
        fix=f'give --pixel-size 0.21mm, or pixel_size = "0.21mm" in {NAME}',
    )


def positions_of(
    flags: SpacingOptions,
    said: StackFile,
    numbers: tuple[int, ...],
    total: int,
    where: Path,
    shown: Shown | None = None,
) -> tuple[FloatArray, str]:
    """Return the sections' positions in mm and who said them.

    A thickness t puts the face of slice k at k·t, the first at 0: each photograph shows the face that
    a cut laid bare, and consecutive cuts are one thickness apart.

    Parameters
    ----------
    flags, said : SpacingOptions, StackFile
        The flags, which win, and the folder's file.
    numbers : tuple of int
        The chosen slices' numbers in the folder, from 0.
    total : int
        Number of slices in the folder; a list of positions may cover all of them or the chosen ones.
    where : Path
        Named in messages.
    shown : Shown, optional
        Whether pictures show both faces of each slice.

    Raises
    ------
    UsageError, InputError
        Unknown, contradictory, not increasing, or not as many as slices.

    Examples
    --------
    >>> positions_of(SpacingOptions(thickness=5), StackFile(), (0, 1, 2), 3, Path("apple"))[0]
    array([ 0.,  5., 10.])
    """
    given, thickness, source = told_spacing(flags, said, where)
    if given is not None:
        return _fitted(given, numbers, total, source), source
    if thickness is not None:
        steps = face_steps(numbers, thickness, kerf_of(flags, said), shown or Shown())
        return steps - steps[0], source
    raise InputError(
        "distance between the slices is unknown",
        where=str(where),
        fix=f'give --thickness 5.6mm or --positions 0,5.6,11.1mm, or thickness = "5.6mm" in {NAME}',
    )


def first_position(
    flags: SpacingOptions,
    said: StackFile,
    numbers: tuple[int, ...],
    where: Path,
    shown: Shown | None = None,
) -> float:
    """Return where the folder's first face lies, mm, on the scale of `positions_of`.

    A camera's distance is that of the folder's first face. Positions given for the chosen slices alone do
    not tell where it lies; the first chosen one is then taken.

    Examples
    --------
    >>> first_position(SpacingOptions(thickness=5), StackFile(), (2, 3), Path("apple"))
    -10.0
    """
    given, thickness, _ = told_spacing(flags, said, where)
    if given is not None:
        return given[0]
    return -float(face_steps(numbers[:1], thickness or 0.0, kerf_of(flags, said), shown or Shown())[0])


def kerf_of(flags: SpacingOptions, said: StackFile) -> float:
    """Return what the blade takes away between two slices, mm; 0 when nobody says so.

    Examples
    --------
    >>> positions_of(SpacingOptions(thickness=5, kerf="0.4mm"), StackFile(), (0, 1, 2), 3, Path("apple"))[0]
    array([ 0. ,  5.4, 10.8])
    """
    if flags.kerf is None:
        return said.kerf or 0.0
    kerf = parse_length(flags.kerf, "--set reader.kerf")
    if kerf < 0:
        raise UsageError("must not be negative", where="--set reader.kerf", found=str(flags.kerf))
    return kerf


def told_spacing(
    flags: SpacingOptions, said: StackFile, where: Path
) -> tuple[tuple[float, ...] | None, float | None, str]:
    """Return the positions or the thickness that were told, mm, and who told them."""
    if flags.thickness is not None and flags.positions is not None:
        raise UsageError("give --thickness or --positions, not both")
    if flags.thickness is not None:
        return None, _positive(flags.thickness, "--thickness"), "--thickness"
    if flags.positions is not None:
        given = flags.positions
        lengths = parse_lengths(given, "--positions") if isinstance(given, str) else given
        return tuple(parse_length(length, "--positions") for length in lengths), None, "--positions"
    if said.thickness is not None and said.positions is not None:
        raise InputError("thickness and positions contradict each other; keep one", where=str(where / NAME))
    return said.positions, said.thickness, NAME


def _fitted(given: tuple[float, ...], numbers: tuple[int, ...], total: int, source: str) -> FloatArray:
    for before, after in pairwise(given):
        if not after > before:
            raise InputError(
                "positions must increase from slice to slice",
                where=source,
                found=f"{after:g} mm after {before:g} mm",
                fix="list them in the natural order of the file names; renumber files cut from the other end",
            )
    if len(given) == total:
        return np.array([given[number] for number in numbers])
    if len(given) == len(numbers):
        return np.array(given)
    raise InputError(
        "positions and slices differ in number",
        where=source,
        found=f"{len(given)} positions for {len(numbers)} slices",
        expected="one position for each slice, in the natural order of the file names",
    )


def _positive(value: float | str, flag: str) -> float:
    length = parse_length(value, flag)
    if length <= 0:
        raise UsageError("must be positive", where=flag, found=str(value), expected="for example 5.6mm")
    return length
