"""What is told of a loft's ends, and what a guessed one may cost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stackloft.geometry.loft_rows import RowEnd, closed_rows
from stackloft.geometry.patch_integrals import solid_integrals
from stackloft.geometry.skin import skin
from stackloft.model.arrays import BoolArray, FloatArray
from stackloft.model.ends import EndKind
from stackloft.model.measurement import EndReport
from stackloft.model.notices import Notice
from stackloft.sectioning.ends import PlannedEnd

OUTERMOST = 5
"""Sections lofted when the effect of a guessed end is worked out; those further in do not feel it."""


def is_plane(end: PlannedEnd) -> bool:
    """Return whether an end is a plane face."""
    return end.kind in {EndKind.FACE, EndKind.FLAT}


def row_end(end: PlannedEnd) -> RowEnd:
    """Return how the rows are closed at an end."""
    return RowEnd(end.length, pole=not is_plane(end), smooth=end.kind is EndKind.ROUND)


def flipped(points: FloatArray) -> FloatArray:
    """Return the stack turned over, so that its last section comes first and z still increases."""
    return np.asarray(points[::-1, ::-1] * np.array([1.0, 1.0, -1.0]))


def end_report(points: FloatArray, corners: BoolArray, end: PlannedEnd, affine: FloatArray) -> EndReport:
    """Return the report of the end beyond points[0], from lofts of the outermost sections alone.

    Parameters
    ----------
    points : (m, N, 3) array, mm
    corners : (m, N) bool array
    end : PlannedEnd
    affine : (4, 4) array
        From stack to bench millimetres.
    """
    report = EndReport(end.kind.value, end.length, end.reason, end.guessed)
    if not end.guessed:
        return report
    outer = slice(0, min(OUTERMOST, len(points)))
    figures = []
    for extreme in end.extremes:
        rows = closed_rows(points[outer], corners[outer], (row_end(extreme), RowEnd(0.0, pole=False)))
        closed = (1.0 if is_plane(extreme) else None, 1.0)
        figures.append(solid_integrals(skin(rows), closed, affine, degree=5))
    volumes, areas = zip(*figures, strict=True)
    return replace(
        report,
        volume_effect=0.5 * (max(volumes) - min(volumes)),
        area_effect=0.5 * (max(areas) - min(areas)),
    )


def guess_notices(reports: tuple[EndReport, ...]) -> tuple[Notice, ...]:
    """Return a notice for each end, first and last, whose position nobody gave."""
    return tuple(
        Notice(
            "end-guessed",
            f"the {which} end's position was guessed ({report.kind}, {report.length:.2f} mm beyond the"
            f" {which} section: {report.reason}); this may cost ±{report.volume_effect or 0.0:.4g} mm³ and"
            f" ±{report.area_effect or 0.0:.4g} mm²: give --height or --ends",
        )
        for which, report in zip(("first", "last"), reports, strict=True)
        if report.guessed
    )
