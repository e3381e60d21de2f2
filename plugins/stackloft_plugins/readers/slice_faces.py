r"""Both faces of every slice: in which order, at which planes, and the lower ones turned back.

::

    slice j   ___________  upper face at j·(t + kerf)          With no kerf the lower face and the next
             |___________| lower face t below, seen turned     upper one are one cut: the upper one is
    slice j+1 ___________  over: its picture is mirrored       used.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stackloft.contracts.stack_file import NAME
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Picture
from stackloft_plugins.readers.what_is_shown import Shown

_UPPER = re.compile(r"top|upper|front", re.IGNORECASE)
_LOWER = re.compile(r"bottom|lower|back", re.IGNORECASE)


def in_pairs(pictures: Sequence[Path], shown: Shown) -> tuple[Path, ...]:
    """Return the pictures with each slice's upper face before its lower one.

    Names that say top, upper or front, and bottom, lower or back, are put so; others are believed.

    Raises
    ------
    InputError
        An odd number of pictures, or a pair whose names do not say so.

    Examples
    --------
    >>> names = ["a_1_bottom.png", "a_1_top.png", "a_2_bottom.png", "a_2_top.png"]
    >>> [path.name for path in in_pairs([Path(name) for name in names], Shown(both=True))]
    ['a_1_top.png', 'a_1_bottom.png', 'a_2_top.png', 'a_2_bottom.png']
    """
    if not shown.both:
        return tuple(pictures)
    if len(pictures) % 2:
        raise InputError(
            "both faces of each slice make an even number of pictures",
            where=str(pictures[0].parent), found=str(len(pictures)),
            fix="add the missing face, or give the faces' positions and leave faces out",
        )  # fmt: skip
    pairs = [tuple(pictures[k : k + 2]) for k in range(0, len(pictures), 2)]
    if not any(_UPPER.search(path.stem) or _LOWER.search(path.stem) for path in pictures):
        return tuple(pictures)
    return tuple(path for pair in pairs for path in _put(pair))


def _put(pair: tuple[Path, ...]) -> tuple[Path, ...]:
    upper = [path for path in pair if _UPPER.search(path.stem) and not _LOWER.search(path.stem)]
    lower = [path for path in pair if _LOWER.search(path.stem) and not _UPPER.search(path.stem)]
    if len(upper) != 1 or len(lower) != 1:
        raise InputError(
            "are not the two faces of one slice, by their names", where=str(pair[0].parent),
            found=" and ".join(path.name for path in pair), expected="slice_3_top and slice_3_bottom",
        )  # fmt: skip
    return upper[0], lower[0]


def face_steps(numbers: Sequence[int], thickness: float, kerf: float, shown: Shown) -> FloatArray:
    """Return where pictures lie below the folder's first one, mm.

    Examples
    --------
    >>> face_steps((0, 1, 2, 3), 5.0, 0.4, Shown(both=True)).tolist()
    [0.0, 5.0, 5.4, 10.4]
    """
    number = np.asarray(numbers)
    if not shown.both:
        return np.asarray(number * (thickness + kerf), dtype=np.float64)
    return np.asarray(number // 2 * (thickness + kerf) + number % 2 * thickness, dtype=np.float64)


def without_doubles(
    numbers: tuple[int, ...], positions: FloatArray, names: Sequence[str], shown: Shown
) -> tuple[tuple[int, ...], tuple[Notice, ...]]:
    """Return the pictures without lower faces that are the same cut as the next upper one."""
    if not shown.both:
        return numbers, ()
    same = {
        a
        for a, b, low, high in zip(numbers, numbers[1:], positions, positions[1:], strict=False)
        if high - low <= 1e-9 * (1 + abs(high))
    }
    if not same:
        return numbers, ()
    listed = ", ".join(names[number] for number in sorted(same)[:4]) + (", …" if len(same) > 4 else "")
    message = (
        f"{listed}: with no kerf they show the same cuts as the upper faces of the next slices, which are "
        f"used; say kerf in {NAME} if the blade took something away"
    )
    return tuple(number for number in numbers if number not in same), (Notice("faces-same", message),)


def turned_over(number: int, shown: Shown) -> str | None:
    """Return how picture `number` of the folder, from 0, is to be turned back; None: it is not."""
    return shown.turned if shown.both and number % 2 == 1 and shown.turned != "no" else None


def turned_back(picture: Picture, how: str | None) -> Picture:
    """Return the picture as seen from above, when its slice was turned over.

    Examples
    --------
    >>> turned_back(np.array([[1, 2], [3, 4]]), "left-right").tolist()
    [[2, 1], [4, 3]]
    """
    if how is None:
        return picture
    return np.ascontiguousarray(picture[:, ::-1] if how == "left-right" else picture[::-1])


def placed_when_turned(
    spacing: FloatArray,
    origins: FloatArray | None,
    shape: tuple[int, int],
    principal: tuple[float, float] | None,
    over: Sequence[str | None],
) -> FloatArray | None:
    """Return pixel (0, 0)'s place in each picture, when some were turned back about their middle.

    The principal point of a picture so turned lies as far from the other edge.
    """
    if principal is None or not any(over):
        return origins
    middle = (np.array(shape[::-1]) - 1.0) / 2
    across = spacing[:, ::-1]
    points = np.array([
        [2 * middle[0] - principal[0] if how == "left-right" else principal[0],
         2 * middle[1] - principal[1] if how == "up-down" else principal[1]]
        for how in over
    ])  # fmt: skip
    return frozen_floats(across[0] * points[0] - across * points)
