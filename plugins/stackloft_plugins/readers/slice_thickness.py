"""The slices' own thickness, and whether all of them together make the height that was told."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from stackloft.contracts.stack_file import StackFile
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import SectionKind
from stackloft_plugins.readers.section_spacing import SpacingOptions, kerf_of, told_spacing
from stackloft_plugins.readers.what_is_shown import Shown

_SURE = 1.01
"""Slices: how far the sum of the thicknesses may be from the height."""


def own_thickness(
    flags: SpacingOptions,
    said: StackFile,
    shown: Shown,
    places: Mapping[int, float],
    where: Path,
    kept: tuple[int, ...],
) -> FloatArray | None:
    """Return the kept slices' own thickness, mm, which silhouettes need; None for faces.

    `places` are the positions of all chosen slices by their number.
    """
    if shown.section is not SectionKind.SILHOUETTE:
        return None
    every = thicknesses_of(flags, said, np.array(list(places.values())), where)
    own = dict(zip(places, every, strict=True))
    return frozen_floats([own[number] for number in kept])


def thicknesses_of(flags: SpacingOptions, said: StackFile, positions: FloatArray, where: Path) -> FloatArray:
    """Return every slice's own thickness, mm: what was told, or from each face to the next less the kerf.

    Examples
    --------
    >>> thicknesses_of(SpacingOptions(positions="0,5,11"), StackFile(), np.array([0.0, 5, 11]), Path("apple"))
    array([5., 6., 6.])
    """
    _, thickness, _ = told_spacing(flags, said, where)
    if thickness is not None:
        return np.full(len(positions), thickness)
    gaps = np.diff(positions) - kerf_of(flags, said)
    if (gaps <= 0).any():
        raise InputError(
            "leaves no thickness between two faces", where="kerf", found=f"{kerf_of(flags, said):g} mm"
        )
    return np.append(gaps, gaps[-1])


def height_notice(
    flags: SpacingOptions, said: StackFile, total: int, where: Path, shown: Shown | None = None
) -> tuple[Notice, ...]:
    """Return a notice when a stated height and the sum of the slices' thicknesses disagree.

    The first picture may show the body's own end or a face one slice into it, and so may the last: the sum
    is sure to one slice. A height below the faces' span is refused where the ends are planned.

    Examples
    --------
    >>> said = StackFile(thickness=5.0, height=90.0)
    >>> height_notice(SpacingOptions(), said, 15, Path("apple"))[0].code
    'height-mismatch'
    """
    _, thickness, _ = told_spacing(flags, said, where)
    if thickness is None or said.height is None:
        return ()
    kerf = kerf_of(flags, said)
    total = total // 2 if shown is not None and shown.both else total
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
