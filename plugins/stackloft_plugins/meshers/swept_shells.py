"""Which shells of a solid a sweep can carry: one tube, or one with a hole from face to face."""

from __future__ import annotations

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import LoftedSolid, Shell, ShellEnd
from stackloft.model.lofted_solid_check import check_lofted_solid

OTHERWISE = "--method fem-tetwild takes any closed solid"
_LEVEL = 1e-6
"""Part of the body's height by which rows of outline and hole may differ."""
_THIN = 0.1
"""Walls thinner than this part of the thickest close over a ridge."""


def swept_tubes(solid: LoftedSolid) -> tuple[tuple[FloatArray, ...], tuple[bool, bool]]:
    """Return a solid's tube, or its outline and hole, in bench millimetres; and where a pole ends it.

    Raises
    ------
    InputError
        The solid is not closed, or not of these kinds.
    """
    check_lofted_solid(solid)
    shells = solid.shells if len(solid.shells) == 1 else _ring(solid)
    outer = shells[0]
    for end in outer.ends:
        if end not in {ShellEnd.POLE, ShellEnd.FACE}:
            raise _unfit("a body that branches", f"an end of the kind {end.value}", "poles and plane faces")
    placed = tuple(shell.patches @ solid.affine[:3, :3].T + solid.affine[:3, 3] for shell in shells)
    return placed, (outer.ends[0] is ShellEnd.POLE, outer.ends[1] is ShellEnd.POLE)


def wall(tubes: tuple[FloatArray, ...]) -> FloatArray:
    """Return the mean thickness between two tubes at each of their rows' rims, mm."""
    areas, lengths = zip(*map(_rim_measures, tubes), strict=True)
    return np.asarray(2.0 * (areas[0] - areas[1]) / (lengths[0] + lengths[1]))


def _rim_measures(patches: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return area and length of the polygon of each row's rim, mm² and mm."""
    points = _rims(patches)
    points = points - points.mean(axis=(0, 1))
    side = np.roll(points, -1, axis=1) - points
    areas = 0.5 * np.linalg.norm(np.cross(points, side).sum(axis=1), axis=1)
    return areas, np.linalg.norm(side, axis=2).sum(axis=1)


def _ring(solid: LoftedSolid) -> tuple[Shell, Shell]:
    """Return outline and hole of a solid with one hole from face to face."""
    shells = sorted(solid.shells, key=lambda shell: ShellEnd.OPENING in shell.ends)
    through = [shell.ends for shell in shells] == [(ShellEnd.FACE,) * 2, (ShellEnd.OPENING,) * 2]
    if not through or solid.joints:
        found = ", ".join("–".join(end.value for end in shell.ends) for shell in shells)
        raise _unfit(
            "a body with several shells (cavities, branches, several holes)",
            f"{len(shells)} shells with the ends {found}",
            "one shell, or one with a hole from face to face",
        )
    outer, hole = shells
    heights = [_rims(shell.patches)[:, 0, 2] for shell in shells]
    alike = len(heights[0]) == len(heights[1]) and np.allclose(
        heights[0], heights[1], rtol=0.0, atol=_LEVEL * float(np.ptp(heights[0]))
    )
    if not alike:
        raise _unfit(
            "a body whose outline and hole go through different heights",
            f"{len(heights[0])} and {len(heights[1])} rows",
            "the same sections",
        )
    thick = wall((outer.patches, hole.patches))
    if thick.min() < _THIN * thick.max():
        raise _unfit("a ring that closes over its ridge", f"a wall of {thick.min():.2g} mm", "plane faces")
    return outer, hole


def _rims(patches: FloatArray) -> FloatArray:
    """Return (rows + 1, columns, 3) the patches' corners."""
    return np.concatenate([patches[:, :, 0, 0], patches[-1:, :, 3, 0]])


def _unfit(what: str, found: str, expected: str) -> InputError:
    return InputError(
        f"{what} cannot be swept", where="mesher sweep", found=found, expected=expected, fix=OTHERWISE
    )
