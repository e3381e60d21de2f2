"""From loops to sections with equally many corresponding points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.correspondence import slide_points
from stackloft.geometry.curve_stack import CurveStack
from stackloft.geometry.point_density import Spread, spread_by_turning
from stackloft.geometry.seams import solve_phases
from stackloft.geometry.simple_polygon import crosses_itself
from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.sectioning.corner_columns import REACH, CornerChain, follow_corners, places_of, share_points
from stackloft.sectioning.loop_curves import ready_curves, ready_loops

COARSEST = 0.55
"""Largest difference in area between a loop's polygon and its curve; 4 points on a circle give 0.525."""
CLOSE = 0.01
STEEP = 8.0
"""A corner moves along its loop by at most this many times the way to the next section, and `CLOSE` of the
loop: sections a hair apart have their corners at the same places."""
SAMPLES = 128
"""Samples of a loop when phases are compared."""
ASIDE = 1e-7
"""Fraction of a loop on either side of a sample at which a corner's two directions are taken."""
MOST_SOLVED = 128
"""Correspondence is solved for at most this many points; more are placed between."""


@dataclass(frozen=True, slots=True, eq=False)
class EqualSections:
    """Sections as corresponding points."""

    points: FloatArray
    """(m, N, 3) mm in stack coordinates; N points counter-clockwise, corresponding along axis 0."""
    corners: BoolArray
    """(m, N): where the boundary really turns."""
    curves: CurveStack
    """The curves the points were taken from."""
    notices: tuple[Notice, ...]


def equal_points(contours: ContourStack, count: int, kept: frozenset[int] = frozenset()) -> EqualSections:
    """Return `count` corresponding points on every section's one outer loop.

    Parameters
    ----------
    contours : ContourStack
        At least two sections, one outer loop each.
    count : int
        N, points per loop, corners among them.
    kept : frozenset of int
        Sections whose corners are points whatever the others have (a joint's edges meet there).

    Raises
    ------
    InputError
        Fewer than two sections; no loop, several loops or holes on a section; a loop without area.
    """
    loops = [_single_loop(section) for section in contours.sections]
    if len(loops) < 2:
        raise InputError(
            "a solid needs at least 2 sections", where=contours.sections[0].name if loops else None,
            found=str(len(loops)), fix="give the whole stack, not one slice",
        )  # fmt: skip
    ready = [loop for own in ready_loops(contours) for loop in own]
    curves = ready_curves(contours)
    _check_fit(curves, contours)
    z = contours.positions
    seams = _solve_seams(curves, ready, contours)
    chains = _chains(curves, seams, count, kept, np.diff(z))
    fractions, fixed = _first_guess(chains, count, seams)
    solved = _slide(curves, z, fractions, fixed)
    plane, _ = curves.at(np.arange(len(ready))[:, None], solved)
    _check_simple(plane, contours)
    points = np.empty((3, count, len(z))).T  # as the skin wants it: along each column from section to section
    points[..., :2], points[..., 2] = plane, z[:, None]
    return EqualSections(points, fixed, curves, seams.notices)


def _check_fit(curves: CurveStack, contours: ContourStack) -> None:
    """Refuse loops so jagged that the smooth curve through their points is another shape."""
    given = curves.polygon_areas
    off = np.abs(curves.areas - given) > COARSEST * given
    if off.any():
        k = int(np.argmax(off))
        raise InputError(
            "the loop is too jagged for a smooth curve through its points",
            where=contours.sections[k].name,
            found=f"area {curves.areas[k]:.4g} mm² by the curve, {given[k]:.4g} mm² by the points",
            fix="give more points, or mark the corners",
        )


def _check_simple(points: FloatArray, contours: ContourStack) -> None:
    """Refuse sections whose points run round in a crossing line."""
    crossing = crosses_itself(points)
    if crossing.any():
        name = contours.sections[int(np.argmax(crossing))].name
        raise InputError(
            "the loop crosses itself",
            where=name,
            fix="draw it anew, or give more --points when it is only finely shaped",
        )


def _single_loop(section: Section) -> Loop:
    """Return the section's one outer loop, or refuse."""
    outer = [loop for loop in section.loops if not loop.hole]
    holes = len(section.loops) - len(outer)
    if len(outer) == 1 and holes == 0:
        return outer[0]
    found = f"{len(outer)} outer loops, {holes} holes" if outer else "no loop"
    raise InputError(
        "this method lofts one closed outer loop per section",
        where=section.name,
        found=found,
        expected="1 outer loop, no hole",
        fix="leave out sections without the body; holes and branches cannot be lofted yet: try"
        " --method cavalieri for the volume alone",
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Seams:
    """How the sections' loops lie to each other before their points slide."""

    phases: FloatArray
    """(m,) fraction of arc length from the canonical start to the seam"""
    corners: list[FloatArray]
    """corner places of each section as fractions from the seam"""
    spread: Spread
    notices: tuple[Notice, ...]


def _solve_seams(curves: CurveStack, loops: list[Loop], contours: ContourStack) -> _Seams:
    """Return each section's seam, its corners counted from there, and notices of near ties."""
    section = np.arange(len(curves))
    samples = np.arange(SAMPLES) / SAMPLES
    point, tangent = curves.at(section[:, None], samples[None, :])
    places = [_corner_places(curves, k, loop.corners) for k, loop in enumerate(loops)]
    seams = solve_phases(point - curves.centroids[:, None, :], _directions(curves, tangent, places), places)
    largest = int(np.argmax(np.round(curves.areas, 9)))
    phases = seams.phases - seams.phases[largest]
    corners = [np.sort(np.mod(p - phase, 1.0)) for p, phase in zip(places, phases, strict=True)]
    names = [s.name for s in contours.sections]
    notices = tuple(_tie_notice(names[k], names[k + 1]) for k in seams.tied)
    return _Seams(phases, corners, spread_by_turning(tangent, places), notices)


def _directions(curves: CurveStack, tangents: FloatArray, places: list[FloatArray]) -> FloatArray:
    """Return the samples' tangents, at a corner the mean of both its sides': rounding must not choose one."""
    if not any(map(len, places)):
        return tangents
    section, sample = (
        np.concatenate(part)
        for part in zip(
            *((np.full(len(own), k), np.round(own * SAMPLES).astype(int)) for k, own in enumerate(places)),
            strict=True,
        )
    )
    sides = [curves.at(section, sample / SAMPLES + aside)[1] for aside in (-ASIDE, ASIDE)]
    mean = np.add(*(side / np.linalg.norm(side, axis=1, keepdims=True) for side in sides))
    turned = np.linalg.norm(mean, axis=1) > ASIDE  # not at a cusp
    result = tangents.copy()
    result[section[turned], sample[turned] % SAMPLES] = mean[turned]
    return result


def _tie_notice(before: str, after: str) -> Notice:
    return Notice(
        "seam-ambiguous",
        f"{after}: two ways of turning it against {before} fit almost equally well; the one nearest to"
        " the twist above and below was taken: cut thinner slices if the body twists",
    )


def _corner_places(curves: CurveStack, section: int, corners: IntArray) -> FloatArray:
    """Return the corners' places as fractions of the loop from the canonical start."""
    if len(corners) == 0:
        return np.empty(0)
    knots = curves.knots[curves.first[section] + corners] - section
    return np.sort(np.mod(knots - curves.starts[section], 1.0))


def _chains(
    curves: CurveStack, seams: _Seams, count: int, kept: frozenset[int], pitches: FloatArray
) -> list[CornerChain]:
    """Return the corners that become points, from section to section."""
    if not any(map(len, seams.corners)):
        return []
    reach = np.minimum(REACH, CLOSE + STEEP * pitches / curves.lengths.max())
    return follow_corners(seams.corners, count, kept, reach, _in_plane(curves, seams), pitches)


def _in_plane(curves: CurveStack, seams: _Seams) -> list[FloatArray]:
    """Return the corners of each section, (c_i, 2) mm."""
    counts = [len(own) for own in seams.corners]
    section = np.repeat(np.arange(len(counts)), counts)
    points = curves.at(section, np.concatenate(seams.corners) + seams.phases[section])[0]
    return np.split(points, np.cumsum(counts)[:-1])


def _first_guess(chains: list[CornerChain], count: int, seams: _Seams) -> tuple[FloatArray, BoolArray]:
    """Return fractions (m, N) from the canonical starts, and which points are corners.

    Between corners the points are spread by `Spread`: evenly but for bends.
    """
    section = np.arange(len(seams.phases))
    fixed = np.zeros((len(section), count), dtype=bool)
    shares = share_points(chains, count) if chains else [count]
    first = np.cumsum(shares) - shares
    places = np.stack([places_of(chain, section) for chain in chains] or [np.zeros(len(section))], axis=1)
    gaps = np.mod(np.diff(places, axis=1), 1.0)
    passed = np.concatenate([np.zeros((len(section), 1)), np.cumsum(gaps, axis=1)], axis=1)
    begin = seams.phases + places[:, 0]
    turns = np.column_stack([begin[:, None] + passed, begin + 1.0])
    ends = seams.spread.share(section[:, None], turns)
    share = np.repeat(np.arange(len(shares)), shares)  # the corner before each point, and how far on
    part = (np.arange(count) - first[share]) / np.array(shares)[share]
    stretch = ends[:, share] + (ends[:, share + 1] - ends[:, share]) * part
    for k, chain in enumerate(chains):
        fixed[list(chain.at), first[k]] = True
    return seams.spread.fraction(section[:, None], stretch), fixed


def _slide(curves: CurveStack, z: FloatArray, fractions: FloatArray, fixed: BoolArray) -> FloatArray:
    """Return the solved fractions; above MOST_SOLVED points every k-th is solved, the rest follow."""
    count = fractions.shape[1]
    stride = -(-count // MOST_SOLVED)
    if stride == 1:
        return slide_points(curves, z, fractions, fixed)
    chosen = np.flatnonzero((np.arange(count) % stride == 0) | fixed.any(axis=0))
    solved = slide_points(curves, z, fractions[:, chosen], fixed[:, chosen])
    shift = solved - fractions[:, chosen]
    wrapped = np.concatenate([chosen, [chosen[0] + count]])
    closed = np.concatenate([shift, shift[:, :1]], axis=1)
    index = np.where(np.arange(count) < chosen[0], np.arange(count) + count, np.arange(count))
    spread: FloatArray = np.stack([np.interp(index, wrapped, row) for row in closed])
    return fractions + spread
