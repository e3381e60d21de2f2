"""A loft of any topology: every tube skinned by itself, joints and openings between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.loft_rows import RowEnd, closed_rows
from stackloft.geometry.skin import skin
from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints, read_only
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.ends import End, EndKind
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import Joint, JointRim, LoftedSolid, Shell, ShellEnd
from stackloft.model.measurement import EndReport
from stackloft.sectioning.ends import PlannedEnd
from stackloft.sectioning.equal_points import EqualSections, equal_points
from stackloft.sectioning.self_check import TubeVolume, check_tubes_against_areas
from stackloft.sectioning.tube_plan import (
    FINER,
    PlannedTube,
    TubeEnd,
    TubePlan,
    more_points,
    plan_tubes,
    replace_row,
)

HAIR = 1e-3
"""A tube of one row alone is given this fraction of its size as height at most."""


@dataclass(frozen=True, slots=True, eq=False)
class _Skinned:
    """A tube as patches."""

    tube: PlannedTube
    sections: EqualSections
    patches: FloatArray


def loft_tubes(
    contours: ContourStack, count: int, said: tuple[End, End], height: float | None
) -> LoftedSolid:
    """Return the solid lofted through sections with any number of loops.

    Parameters
    ----------
    contours : ContourStack
    count : int
        Points per loop.
    said : pair of End
    height : float, optional
        mm

    Raises
    ------
    InputError
        The sections cannot be linked or lofted.
    """
    if len(contours) < 2:
        raise InputError(
            "a solid needs at least 2 sections", found=str(len(contours)),
            fix="give the whole stack, not one slice",
        )  # fmt: skip
    plan = plan_tubes(contours, said, height)
    skinned = [_skinned(tube, contours, count) for tube in plan.tubes]
    _check(skinned, contours, plan.areas)
    reports = _reports(skinned)
    notices = [*plan.traced.notices, *(n for one in skinned for n in one.sections.notices)]
    return LoftedSolid(
        tuple(_shell(one) for one in skinned),
        reports,
        contours.affine,
        tuple(notices),
        _joints(plan),
    )


def _skinned(tube: PlannedTube, contours: ContourStack, count: int) -> _Skinned:
    rows = tube.rows
    if len(rows) == 1:  # both ends are planned beyond it
        hair = HAIR * float(np.ptp(rows[0].loop.points))
        if tube.ends[1].planned is None:  # the joint's row keeps its place
            rows = (replace_row(rows[0], rows[0].z - hair), rows[0])
        else:
            rows = (rows[0], replace_row(rows[0], rows[0].z + hair))
    loops = [Loop(frozen_floats(row.loop.points), frozen_ints(row.loop.corners)) for row in rows]
    sections = tuple(Section(row.z, (loop,), row.name) for row, loop in zip(rows, loops, strict=True))
    stack = ContourStack(sections, contours.kind, exact=True, affine=contours.affine)
    kept = frozenset(k for k, row in enumerate(rows) if row.pinned)
    finer = FINER if any(row.section is None for row in tube.rows) else more_points(stack)
    equal = equal_points(stack, finer * count, kept)
    ends = (_row_end(tube.ends[0]), _row_end(tube.ends[1]))
    patches = skin(closed_rows(equal.points, equal.corners, ends))
    return _Skinned(tube, equal, patches)


def _row_end(end: TubeEnd) -> RowEnd:
    if end.planned is None:
        return RowEnd(0.0, pole=False)
    return RowEnd(
        end.planned.length, pole=not _is_plane(end.planned), smooth=end.planned.kind is EndKind.ROUND
    )


def _is_plane(end: PlannedEnd) -> bool:
    return end.kind in {EndKind.FACE, EndKind.FLAT}


def _shell(one: _Skinned) -> Shell:
    patches = one.patches[:, ::-1, :, ::-1] if one.tube.hole else one.patches
    return Shell(
        read_only(np.ascontiguousarray(patches)), (_shell_end(one.tube.ends[0]), _shell_end(one.tube.ends[1]))
    )


def _shell_end(end: TubeEnd) -> ShellEnd:
    if end.planned is None:
        return ShellEnd.JOINT
    if not _is_plane(end.planned):
        return ShellEnd.POLE
    return ShellEnd.OPENING if end.opening else ShellEnd.FACE


def _joints(plan: TubePlan) -> tuple[Joint, ...]:
    rims: list[list[JointRim]] = [[] for _ in plan.traced.joints]
    for number, tube in enumerate(plan.tubes):
        for at_last, end in zip((False, True), tube.ends, strict=True):
            if end.joint is not None:
                rims[end.joint.joint].append(JointRim(number, at_last, end.joint.edges))
    return tuple(
        Joint(tuple(frozen_floats(edge) for edge in edges), tuple(own))
        for edges, own in zip(plan.traced.joints, rims, strict=True)
    )


def _check(skinned: list[_Skinned], contours: ContourStack, areas: FloatArray) -> None:
    """Hold the skins between the outermost sections against the sections' areas."""
    z = contours.positions
    volumes = []
    for one in skinned:
        low = one.patches[:, 0, 0, 0, 2]
        high = one.patches[:, 0, 3, 0, 2]
        within = (low >= z[0] - 1e-9 * np.ptp(z)) & (high <= z[-1] + 1e-9 * np.ptp(z))
        chosen = np.flatnonzero(within)
        if len(chosen):
            rows = slice(int(chosen[0]), int(chosen[-1]) + 1)
            volumes.append(TubeVolume(one.patches[rows], -1.0 if one.tube.hole else 1.0))
    names = tuple(section.name for section in contours.sections)
    check_tubes_against_areas(volumes, z, areas, names)


def _reports(skinned: list[_Skinned]) -> tuple[EndReport, ...]:
    """Return what is told of the first and the last end: that of the largest tube."""
    reports = []
    for k in (0, 1):
        outer = [one for one in skinned if one.tube.ends[k].outer and not one.tube.hole]
        outer.sort(key=lambda one: -abs(one.tube.rows[-1 if k else 0].loop.signed_area))
        main = outer[0].tube.ends[k].planned if outer else None
        if main is None:
            reports.append(EndReport("face", 0.0, "nothing ends there", guessed=False))
            continue
        reports.append(EndReport(main.kind.value, main.length, main.reason, main.guessed))
    return tuple(reports)
