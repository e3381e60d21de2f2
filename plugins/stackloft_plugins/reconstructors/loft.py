"""Loft: equal-point closed B-splines skinned across sections and closed at both ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from stackloft.contracts.options import option
from stackloft.geometry.folds import folded_rows
from stackloft.geometry.loft_rows import closed_rows
from stackloft.geometry.second_moments import half_axes
from stackloft.geometry.skin import skin
from stackloft.model.arrays import FloatArray, read_only
from stackloft.model.contour_stack import ContourStack
from stackloft.model.ends import End, EndKind
from stackloft.model.errors import InputError
from stackloft.model.lengths import parse_length
from stackloft.model.lofted_solid import LoftedSolid, Shell, ShellEnd
from stackloft.model.measurement import EndReport
from stackloft.sectioning.canonical_pose import canonical_flip, flipped_stack
from stackloft.sectioning.drawn import is_drawn
from stackloft.sectioning.ends import PlannedEnd, StackEnds, plan_ends
from stackloft.sectioning.equal_points import EqualSections, equal_points
from stackloft.sectioning.self_check import check_against_areas
from stackloft.sectioning.tube_plan import is_single, more_points
from stackloft.sectioning.weak_overlap import weak_overlaps
from stackloft_plugins.reconstructors.end_reports import (
    end_report,
    flipped,
    guess_notices,
    is_plane,
    row_end,
)
from stackloft_plugins.reconstructors.loft_tubes import loft_tubes
from stackloft_plugins.reconstructors.skin_areas import slipped_rows

FEWEST = 2
"""Sections that a solid needs."""


@dataclass(frozen=True)
class LoftReconstructor:
    """Goñi, Purlis & Salvadori (2007): sections as closed B-splines with equally many points, lofted.

    Unlike the original, the ends are closed by poles where the body is round or pointed, points
    correspond by position and not by arc length alone, and corners are kept. Exact for prisms; errs low
    by the sections' interpolation error on bodies that change faster than the pitch.
    """

    points: int = option(
        33,
        "points per section, corners among them; long or branching loops get three times as many",
        ge=5,
        le=2000,
        source="Goñi, Purlis & Salvadori (2007)",
    )
    ends: str | None = option(
        None, "how the body ends, FIRST[,LAST]: auto, face, flat:LEN, round[:LEN], point[:LEN]"
    )
    height: float | None = option(None, "the body's whole length along the axis", unit="mm", gt=0)
    inner_ends: str = option(
        "auto",
        "how cavities and pieces end that begin or end between two sections: as their areas tell (areas), or"
        " flat on their own outermost section (face), when sections lie at the very heights of their floors"
        " and roofs; auto is face for drawn polygons with both ends told as faces, else areas",
        choices=("auto", "areas", "face"),
    )

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (ContourStack,)
    produces: ClassVar[tuple[type, ...]] = (LoftedSolid,)

    def reconstruct(self, product: ContourStack) -> LoftedSolid:
        """Return the lofted solid.

        Parameters
        ----------
        product : ContourStack
            At least two sections.

        Raises
        ------
        InputError
            The sections cannot be lofted, or ends and height contradict each other.
        """
        if len(product) < FEWEST:
            raise InputError(
                "a solid needs at least 2 sections",
                where=product.sections[0].name if len(product) else None,
                found=str(len(product)),
                fix="give the whole stack, not one slice",
            )
        flip = canonical_flip(product)
        return self._lofted(flipped_stack(product, flip)).flipped(flip)

    def _lofted(self, product: ContourStack) -> LoftedSolid:
        """Return the solid of a stack in its canonical pose."""
        if not is_single(product):
            return self._tubes(product)
        sections = equal_points(product, self.points * more_points(product))
        planned = plan_ends(_stack_ends(product, sections), self._said(product), self._height(product))
        patches = _patches(sections, planned)
        inner = patches[_inner_rows(patches, planned)]
        if folded_rows(inner).any() or slipped_rows([inner]):
            return self._tubes(product)
        _self_check(patches, planned, sections, product)
        reports = _reports(sections, planned, product)
        shell = Shell(read_only(patches), (_shell_end(planned[0]), _shell_end(planned[1])))
        notices = (*sections.notices, *weak_overlaps(sections, product), *guess_notices(reports))
        return LoftedSolid((shell,), reports, product.affine, notices)

    def _tubes(self, contours: ContourStack) -> LoftedSolid:
        said, height = self._said(contours), self._height(contours)
        faces = self.inner_ends == "face"
        if self.inner_ends == "auto":
            faces = all(end.kind is EndKind.FACE for end in said) and is_drawn(contours)
        return loft_tubes(contours, self.points, said, height, inner_faces=faces)

    def _said(self, contours: ContourStack) -> tuple[End, End]:
        if self.ends is not None:
            return End.parse_pair(self.ends)
        return contours.hints.ends or (End(), End())

    def _height(self, contours: ContourStack) -> float | None:
        if self.height is not None:
            return parse_length(self.height, "--height")
        return contours.hints.height


def _stack_ends(contours: ContourStack, sections: EqualSections) -> StackEnds:
    areas, widths = sections.curves.areas, half_axes(sections.points)[:, 1]
    kind, thickness = contours.kind, contours.thickness
    return StackEnds(contours.positions, areas, kind, thickness, contours.seen_beyond, widths)


def _shell_end(end: PlannedEnd) -> ShellEnd:
    return ShellEnd.FACE if is_plane(end) else ShellEnd.POLE


def _patches(sections: EqualSections, planned: tuple[PlannedEnd, PlannedEnd]) -> FloatArray:
    ends = (row_end(planned[0]), row_end(planned[1]))
    return skin(closed_rows(sections.points, sections.corners, ends))


def _inner_rows(patches: FloatArray, planned: tuple[PlannedEnd, PlannedEnd]) -> slice:
    """Return the rows of patches between the first and the last section."""
    first, last = (int(end.length > 0.0) for end in planned)
    return slice(first, len(patches) - last)


def _self_check(
    patches: FloatArray,
    planned: tuple[PlannedEnd, PlannedEnd],
    sections: EqualSections,
    contours: ContourStack,
) -> None:
    """Hold the skin between the outermost sections against their areas."""
    rows = _inner_rows(patches, planned)
    names = tuple(section.name for section in contours.sections)
    check_against_areas(patches, rows, contours.positions, sections.curves.areas, names)


def _reports(
    sections: EqualSections, planned: tuple[PlannedEnd, PlannedEnd], contours: ContourStack
) -> tuple[EndReport, EndReport]:
    """Return what is told of each end; a guessed one with what the guess may cost."""
    first = end_report(sections.points, sections.corners, planned[0], contours.affine)
    last = end_report(flipped(sections.points), sections.corners[::-1], planned[1], contours.affine)
    return first, last
