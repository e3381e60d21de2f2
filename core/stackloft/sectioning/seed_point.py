"""The body at a point that somebody has pointed to, in patient millimetres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import UsageError
from stackloft.model.lengths import parse_lengths
from stackloft.model.segmentation import Segmentation
from stackloft.model.slice_stack import SliceStack

SEED = "seed:"
"""What begins the name of a body that is told by a point in it."""


def seed_of(text: str) -> FloatArray:
    """Return the point that ``seed:X,Y,Z`` means, (3) patient mm.

    Raises
    ------
    UsageError
        No three lengths.

    Examples
    --------
    >>> seed_of("seed:-12.5,3cm,0")
    array([-12.5,  30. ,   0. ])
    """
    point = np.array(parse_lengths(text.removeprefix(SEED), "--object seed:…"))
    if point.shape != (3,):
        raise UsageError(
            "a seed is a point in space",
            where="--object",
            found=text,
            expected="seed:X,Y,Z, as seed:-12,30,55.5mm",
        )
    return point


def body_at(bodies: Sequence[Segmentation], point: FloatArray) -> int:
    """Return which of the bodies is at a point: the pixel it lies in, on the nearest slice, is body.

    Raises
    ------
    UsageError
        The point lies in none of them, or beyond all slices.

    Examples
    --------
    >>> from stackloft.model.segmentation import SectionField
    >>> from stackloft.model.slice_stack import SectionKind
    >>> picture = np.zeros((9, 9))
    >>> picture[2:5, 3:6] = 1.0
    >>> stack = SliceStack(lambda k: picture, ("a", "b"), (9, 9), np.array([0.0, 5.0]), np.ones((2, 2)),
    ...                    SectionKind.SLAB)
    >>> body_at([Segmentation(stack, lambda k, picture: SectionField(picture, 0.5))], np.array([4.0, 3, 6]))
    0
    """
    for number, body in enumerate(bodies):
        if _is_inside(body, point):
            return number
    told = ", ".join(f"{value:g}" for value in point)
    raise UsageError(
        "no body is at that point",
        where=f"--object seed:{told}",
        found=f"background, or beyond the slices, at ({told}) mm in patient space",
        expected=f"a point in one of {len(bodies)} bodies",
        fix="`stackloft info` tells the affine from pixels to patient millimetres",
    )


def _is_inside(body: Segmentation, point: FloatArray) -> bool:
    stack = body.stack
    x, y, z = np.linalg.solve(stack.affine, np.append(point, 1.0))[:3]
    k = int(np.argmin(np.abs(stack.positions - z)))
    if abs(float(stack.positions[k]) - z) > _half_gap(stack, k):
        return False
    origin = np.zeros(2) if stack.origins is None else stack.origins[k]
    row_step, column_step = stack.pixel_spacing[k]
    row, column = round((y - origin[1]) / row_step), round((x - origin[0]) / column_step)
    section = body.field_of(k, stack.decode(k))
    row, column = row - section.offset[0], column - section.offset[1]
    rows, columns = section.values.shape
    if not (0 <= row < rows and 0 <= column < columns):
        return False
    level = section.level if section.local_levels is None else section.local_levels[row, column]
    return bool(section.values[row, column] > level)


def _half_gap(stack: SliceStack, k: int) -> float:
    gaps = np.diff(stack.positions)
    beside = gaps[max(0, k - 1) : k + 1]
    return 0.5 * float(beside.max()) if len(beside) else float("inf")
