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
from stackloft.model.notices import Notice

_SURE = 1.01
"""Slices: how far the sum of the thicknesses may be from the height."""


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
    flags: SpacingOptions, said: StackFile, numbers: tuple[int, ...], total: int, where: Path
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

    Raises
    ------
    UsageError, InputError
        Unknown, contradictory, not increasing, or not as many as slices.

    Examples
    --------
    >>> positions_of(SpacingOptions(thickness=5), StackFile(), (0, 1, 2), 3, Path("apple"))[0]
    array([ 0.,  5., 10.])
    """
    given, thickness, source = _chosen(flags, said, where)
    if given is not None:
        return _fitted(given, numbers, total, source), source
    if thickness is not None:
        pitch = thickness + kerf_of(flags, said)
        return (np.array(numbers) - numbers[0]) * pitch, source
    raise InputError(
        "distance between the slices is unknown",
        where=str(where),
        fix=f'give --thickness 5.6mm or --positions 0,5.6,11.1mm, or thickness = "5.6mm" in {NAME}',
    )


def first_position(flags: SpacingOptions, said: StackFile, numbers: tuple[int, ...], where: Path) -> float:
    """Return where the folder's first face lies, mm, on the scale of `positions_of`.

    A camera's distance is that of the folder's first face. Positions given for the chosen slices alone do
    not tell where it lies; the first chosen one is then taken.

    Examples
    --------
    >>> first_position(SpacingOptions(thickness=5), StackFile(), (2, 3), Path("apple"))
    -10.0
    """
    given, thickness, _ = _chosen(flags, said, where)
    if given is not None:
        return given[0]
    return -numbers[0] * ((thickness or 0.0) + kerf_of(flags, said))


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


def height_notice(flags: SpacingOptions, said: StackFile, total: int, where: Path) -> tuple[Notice, ...]:
    """Return a notice when a stated height and the sum of the slices' thicknesses disagree.

    The first picture may show the body's own end or a face one slice into it, and so may the last: the sum
    is sure to one slice. A height below the faces' span is refused where the ends are planned.

    Examples
    --------
    >>> said = StackFile(thickness=5.0, height=90.0)
    >>> height_notice(SpacingOptions(), said, 15, Path("apple"))[0].code
    'height-mismatch'
    """
    _, thickness, _ = _chosen(flags, said, where)
    if thickness is None or said.height is None:
        return ()
    kerf = kerf_of(flags, said)
    summed = total * thickness + (total - 1) * kerf
    if abs(said.height - summed) <= (thickness + kerf) * _SURE:
        return ()
    message = (
        f"{where.name}: {total} slices of {thickness:g} mm"
        + (f" and cuts of {kerf:g} mm" if kerf else "")
        + f" make {summed:g} mm, but the height is said to be {said.height:g} mm: "
        f"{abs(said.height - summed) / (thickness + kerf):.1f} slices of difference"
    )
    return (Notice("height-mismatch", message),)


def _chosen(
    flags: SpacingOptions, said: StackFile, where: Path
) -> tuple[tuple[float, ...] | None, float | None, str]:
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
