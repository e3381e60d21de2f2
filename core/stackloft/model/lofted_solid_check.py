"""Whether a lofted solid is closed: patches share their rims, ends close."""

from __future__ import annotations

import numpy as np

from stackloft.geometry.bezier_patch import patch_planes
from stackloft.model.arrays import FloatArray
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import Joint, LoftedSolid, Shell, ShellEnd

TOLERANCE = 1e-9
"""Largest gap between shared rims, as a fraction of the shell's size."""
RIM_TOLERANCE = 0.02
"""Largest distance between a shell's own points and the edges of its joint, as a fraction of its size: both
go through the same curve, at other points."""


def check_lofted_solid(solid: LoftedSolid) -> None:
    """Raise InputError unless every shell is a closed tube.

    Raises
    ------
    InputError
        No shell, points that are not finite, neighbouring patches that do not share their rim, an end that
        is neither a pole nor a plane rim, or a joint whose edges do not close or leave the shells' rims.
    """
    if not solid.shells:
        raise InputError("the solid has no surface")
    for number, shell in enumerate(solid.shells, start=1):
        _check_shell(shell, f"shell {number}")
    joined = [rim for joint in solid.joints for rim in joint.rims]
    for number, shell in enumerate(solid.shells):
        for at_last, end in zip((False, True), shell.ends, strict=True):
            count = sum(rim.shell == number and rim.at_last is at_last for rim in joined)
            if count != (end is ShellEnd.JOINT):
                raise InputError(
                    "the surface is open", where=f"shell {number + 1}", found=f"a rim in {count} joints"
                )
    whole = max(_size(shell.patches) for shell in solid.shells) if solid.joints else 0.0
    for number, joint in enumerate(solid.joints, start=1):
        _check_joint(joint, solid.shells, whole, f"joint {number}")


def _check_joint(joint: Joint, shells: tuple[Shell, ...], whole: float, name: str) -> None:
    """Raise unless every edge serves two rims and the rims follow their shells."""
    uses = sorted(edge for rim in joint.rims for edge, _ in rim.edges)
    if uses != sorted([*range(len(joint.edges))] * 2):
        raise InputError("the surface is open", where=name, found="an edge that does not belong to two rims")
    for rim in joint.rims:
        patches = shells[rim.shell].patches
        size = _size(patches)
        runs = [joint.edges[edge][:: 1 if forward else -1] for edge, forward in rim.edges]
        following = [*runs[1:], runs[0]]
        for run, after in zip(runs, following, strict=True):
            _check_gap(run[-1] - after[0], size, name)
        points = patches[-1, :, 3, 0] if rim.at_last else patches[0, :, 0, 0]
        away = _furthest(points, np.concatenate(runs))
        if away > RIM_TOLERANCE * max(size, 0.1 * whole):
            raise InputError("a rim leaves its joint", where=name, found=f"by {away:g} mm")


def _furthest(points: FloatArray, polygon: FloatArray) -> float:
    """Return the greatest distance of points from a closed polygon's sides, mm."""
    side = np.roll(polygon, -1, axis=0) - polygon
    squared = np.maximum((side**2).sum(axis=1), 1e-300)
    arm = points[:, None] - polygon[None]
    t = np.clip((arm * side).sum(axis=-1) / squared, 0.0, 1.0)
    return float(np.sqrt(((arm - t[..., None] * side) ** 2).sum(axis=-1).min(axis=1).max()))


def _check_shell(shell: Shell, name: str) -> None:
    patches = shell.patches
    if patches.ndim != 5 or patches.shape[2:] != (4, 4, 3) or 0 in patches.shape:
        raise InputError("not a grid of bicubic patches", where=name, found=str(patches.shape))
    size = _size(patches)
    if not np.isfinite(size):
        raise InputError("points that are not finite", where=name)
    around = f"{name}, along the loop"
    _check_gap(patches[:, :-1, :, 3] - patches[:, 1:, :, 0], size, around)
    _check_gap(patches[:, -1, :, 3] - patches[:, 0, :, 0], size, around)
    _check_gap(patches[:-1, :, 3] - patches[1:, :, 0], size, f"{name}, across sections")
    for rim, end, which in zip((patches[0, :, 0], patches[-1, :, 3]), shell.ends, _ENDS, strict=True):
        flat = rim - rim[0, 0] if end is ShellEnd.POLE else rim[..., 2] - rim[0, 0, 2]
        _check_gap(flat, size, f"{name}, {which} end")


def _size(patches: FloatArray) -> float:
    """Return the longest side of the box around all control points, mm; not finite where they are not."""
    planes = patch_planes(patches)
    ends = planes.max(axis=(0, 1, 3, 4)) - planes.min(axis=(0, 1, 3, 4))
    return float(ends.max())  # NumPy's largest of anything and nan is nan


_ENDS = ("first", "last")


def _check_gap(gap: FloatArray, size: float, where: str) -> None:
    if gap.size and (widest := float(np.abs(gap).max())) > TOLERANCE * size:
        raise InputError("the surface is open", where=where, found=f"a gap of {widest:g} mm")
