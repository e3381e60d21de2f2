"""A loft of any topology: every tube skinned by itself, joints and openings between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, read_only
from stackloft.model.contour_stack import ContourStack
from stackloft.model.ends import End
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import Joint, JointRim, LoftedSolid, Shell, ShellEnd
from stackloft.model.measurement import EndReport
from stackloft.sectioning.self_check import TubeVolume, check_tubes_against_areas
from stackloft.sectioning.stack_roofs import Roof
from stackloft.sectioning.tube_ends import FACE, ON_SECTION, TubeEnd
from stackloft.sectioning.tube_plan import TubePlan
from stackloft_plugins.reconstructors.end_reports import (
    end_report,
    flipped,
    guess_notices,
    is_plane,
)
from stackloft_plugins.reconstructors.skin_areas import (
    Skinned,
    check_skin_areas,
)
from stackloft_plugins.reconstructors.tube_skins import skinned_tubes


def loft_tubes(
    contours: ContourStack,
    count: int,
    said: tuple[End, End],
    height: float | None,
    *,
    inner_faces: bool = False,
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
    inner_faces : bool
        What begins or ends between two sections ends in a plane face on its own outermost section.

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
    plan, skinned = skinned_tubes(contours, count, said, height, inner_faces=inner_faces)
    _check(skinned, contours, plan.areas)
    check_skin_areas(skinned)
    reports = _reports(skinned, plan, contours.affine)
    notices = [
        *plan.traced.notices,
        *(n for one in skinned for n in one.sections.notices),
        *guess_notices(reports),
    ]
    return LoftedSolid(
        tuple(_shell(one) for one in skinned),
        reports,
        contours.affine,
        tuple(notices),
        _joints(plan),
    )


def _shell(one: Skinned) -> Shell:
    patches = one.patches[:, ::-1, :, ::-1] if one.tube.hole else one.patches
    return Shell(
        read_only(np.ascontiguousarray(patches)), (_shell_end(one.tube.ends[0]), _shell_end(one.tube.ends[1]))
    )


def _shell_end(end: TubeEnd) -> ShellEnd:
    if end.planned is None:
        return ShellEnd.JOINT
    if not is_plane(end.planned):
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


def _check(skinned: list[Skinned], contours: ContourStack, areas: FloatArray) -> None:
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
    check_tubes_against_areas(volumes, _courses(skinned, z, areas), names)


def _courses(skinned: list[Skinned], z: FloatArray, areas: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """Return the areas' courses along the axis: of tubes with told faces each its own, of all others one."""
    rest, courses = areas.copy(), []
    for one in skinned:
        if not any(end.planned is ON_SECTION for end in one.tube.ends):
            continue
        own = [(row.section, row.loop.signed_area) for row in one.tube.rows if row.section is not None]
        at = np.array([section for section, _ in own])
        signed = np.array([-abs(area) if one.tube.hole else abs(area) for _, area in own])
        rest[at] -= signed
        courses.append((z[at], signed))
    return [(z, rest), *courses]


def _reports(skinned: list[Skinned], plan: TubePlan, affine: FloatArray) -> tuple[EndReport, EndReport]:
    """Return what is told of the first and the last end: that of its largest piece, and what guesses cost."""
    return _side_report(skinned, plan.roofs[0], affine, 0), _side_report(skinned, plan.roofs[1], affine, 1)


def _side_report(skinned: list[Skinned], roofs: tuple[Roof, ...], affine: FloatArray, k: int) -> EndReport:
    reports: list[tuple[float, EndReport]] = []
    for one in skinned:
        end = one.tube.ends[k]
        if not end.outer or end.planned is None or one.tube.hole or end.planned is FACE:
            continue
        points, corners = one.sections.points, one.sections.corners
        if k:
            points, corners = flipped(points), corners[::-1]
        size = abs(one.tube.rows[-1 if k else 0].loop.signed_area)
        reports.append((size, end_report(points, corners, end.planned, affine)))
    reports += [(roof.area, roof.report()) for roof in roofs]
    if not reports:
        return EndReport("face", 0.0, "nothing of the body reaches it", guessed=False)
    main = max(reports, key=lambda item: item[0])[1]
    guessed = [report for _, report in reports if report.guessed]
    if not guessed:
        return main
    return replace(
        main,
        guessed=True,
        volume_effect=sum(report.volume_effect or 0.0 for report in guessed),
        area_effect=sum(report.area_effect or 0.0 for report in guessed),
    )
