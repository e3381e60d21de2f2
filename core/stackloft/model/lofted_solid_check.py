"""Whether a lofted solid is closed: patches share their rims, ends close."""

from __future__ import annotations

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import LoftedSolid, Shell

TOLERANCE = 1e-9
"""Largest gap between shared rims, as a fraction of the shell's size."""


def check_lofted_solid(solid: LoftedSolid) -> None:
    """Raise InputError unless every shell is a closed tube.

    Raises
    ------
    InputError
        No shell, points that are not finite, neighbouring patches that do not share their rim, or an end
        that is neither a pole nor a plane rim.
    """
    if not solid.shells:
        raise InputError("the solid has no surface")
    for number, shell in enumerate(solid.shells, start=1):
        _check_shell(shell, f"shell {number}")


def _check_shell(shell: Shell, name: str) -> None:
    patches = shell.patches
    if patches.ndim != 5 or patches.shape[2:] != (4, 4, 3) or 0 in patches.shape:
        raise InputError("not a grid of bicubic patches", where=name, found=str(patches.shape))
    if not np.isfinite(patches).all():
        raise InputError("points that are not finite", where=name)
    size = float(np.ptp(patches.reshape(-1, 3), axis=0).max())
    _check_gap(
        patches[:, :, :, 3] - np.roll(patches, -1, axis=1)[:, :, :, 0], size, f"{name}, along the loop"
    )
    _check_gap(patches[:-1, :, 3] - patches[1:, :, 0], size, f"{name}, across sections")
    for rim, plane, which in zip((patches[0, :, 0], patches[-1, :, 3]), shell.plane_ends, _ENDS, strict=True):
        flat = rim[..., 2] - rim[0, 0, 2] if plane else rim - rim[0, 0]
        _check_gap(flat, size, f"{name}, {which} end")


_ENDS = ("first", "last")


def _check_gap(gap: FloatArray, size: float, where: str) -> None:
    if gap.size and (widest := float(np.abs(gap).max())) > TOLERANCE * size:
        raise InputError("the surface is open", where=where, found=f"a gap of {widest:g} mm")
