"""Every tube of a body skinned, and mended where a straight skin will not do."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from stackloft.geometry.folds import folded_rows
from stackloft.geometry.loft_rows import RowEnd, closed_rows
from stackloft.geometry.skin import skin
from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.ends import End
from stackloft.model.errors import InputError
from stackloft.sectioning.equal_points import equal_points
from stackloft.sectioning.mends import Mends
from stackloft.sectioning.self_check import fold_error
from stackloft.sectioning.tube_ends import PlannedTube, TubeEnd, replace_row
from stackloft.sectioning.tube_plan import FINER, TubePlan, more_points, plan_tubes
from stackloft_plugins.reconstructors.end_reports import row_end
from stackloft_plugins.reconstructors.limb_choice import limbs_worth_cutting
from stackloft_plugins.reconstructors.skin_areas import Skinned, first_patch, slipped_sections

SLIGHT = 0.05
"""Tubes thinner than this fraction of the largest section may fold unseen: a crumb, a tip of two sections."""
HAIR = 1e-3
"""A tube of one row alone is given this fraction of its size as height at most."""


def skinned_tubes(
    contours: ContourStack,
    count: int,
    said: tuple[End, End],
    height: float | None,
    *,
    inner_faces: bool,
) -> tuple[TubePlan, list[Skinned]]:
    """Return the tubes and their skins, mended where they fold or slip, limbs cut where that is less.

    Parameters are those of `loft_tubes`.

    Raises
    ------
    InputError
        The sections cannot be linked, or a skin folds whatever is done.
    """

    def skinned_with(mended: Mends) -> tuple[TubePlan, list[Skinned], Mends]:
        while True:
            plan = plan_tubes(contours, said, height, mended, inner_faces=inner_faces)
            skinned = [_skinned(tube, contours, count) for tube in plan.tubes]
            folds = _folds(skinned)
            more = mended.more(folds.keys(), slipped_sections(skinned), plan.traced.limbs)
            if more == mended:
                break
            mended = more
        if folds:
            raise fold_error(*folds[min(folds)])
        return plan, skinned, mended

    plan, skinned, mended = skinned_with(Mends())
    if plan.traced.limbs <= mended.limbs:
        return plan, skinned
    try:
        every = replace(mended, limbs=plan.traced.limbs)
        cut = skinned_with(every)
        worth = limbs_worth_cutting(skinned, cut[1], every.limbs - mended.limbs, contours.positions)
        if worth | mended.limbs == every.limbs:
            return cut[:2]
        if worth:
            return skinned_with(replace(mended, limbs=mended.limbs | worth))[:2]
    except InputError:
        pass  # they cannot be cut
    return plan, skinned


def _skinned(tube: PlannedTube, contours: ContourStack, count: int) -> Skinned:
    rows = tube.rows
    if len(rows) == 1:  # both ends are planned beyond it
        hair = HAIR * float(np.ptp(rows[0].loop.points))
        if (
            tube.ends[1].planned is None or tube.ends[1].outer
        ):  # the joint's or the face's row keeps its place
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
    return Skinned(tube, equal, patches)


def _row_end(end: TubeEnd) -> RowEnd:
    return RowEnd(0.0, pole=False) if end.planned is None else row_end(end.planned)


def _folds(skinned: list[Skinned]) -> dict[int, tuple[str, str]]:
    """Return the sections after which a skin folds, with their names and the next ones'.

    Levels put in lie closer together than their loops are known; between them nothing is looked for.
    """
    found = {}
    sizes = [max(abs(row.loop.signed_area) for row in one.tube.rows) for one in skinned]
    for one, size in zip(skinned, sizes, strict=True):
        if size < SLIGHT * max(sizes):
            continue
        rows = one.tube.rows
        first = first_patch(one)
        pairs = [
            (k, low, high)
            for k, (low, high) in enumerate(pairwise(rows))
            if low.section is not None and high.section is not None and low.section != high.section
        ]
        if not pairs:
            continue
        folded = folded_rows(one.patches[[first + k for k, _, _ in pairs]])
        for (_, low, high), bad in zip(pairs, folded, strict=True):
            if bad and low.section is not None:
                found[low.section] = (low.name, high.name)
    return found
