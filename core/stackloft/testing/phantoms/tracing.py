"""From the inequalities on a plane to closed loops whose points lie on the boundary to rounding.

A grid of signs finds the loops; Newton's method puts their points on the boundary; where the active
inequality changes there is a corner, solved as the common zero of the two; between corners the points
are spread by equal arc length and put on the boundary again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import Loop
from stackloft.model.errors import InputError
from stackloft.testing.phantoms.nesting import oriented
from stackloft.testing.phantoms.plane_cut import PlaneCut

_TINY = 1e-9
_SAME = 1e-5
_SPREADS = 3
_FITS = 12
_FINER = (1, 3, 9, 27)
"""Times as many steps are tried."""
_MET = 1e-6
"""A corner is this near to both boundaries, in sizes of the section."""


@dataclass(frozen=True, slots=True, eq=False)
class _Arc:
    """Part of a loop on one field, from corner to corner; a loop without corners is one closed arc."""

    piece: int
    points: FloatArray
    """(2, k) mm, both ends included; the ends are equal when the arc is a whole loop."""

    @property
    def length(self) -> float:
        return float(np.hypot(*np.diff(self.points)).sum())


def trace(
    cut: PlaneCut, box: tuple[FloatArray, FloatArray], points: int, detail: int = 121
) -> tuple[Loop, ...]:
    """Return the loops of the section inside `box` with about `points` points on each.

    Parameters
    ----------
    cut : PlaneCut
        The inequalities on the plane.
    box : pair of array (2)
        Lower and upper corner of a rectangle about the section, mm; it is grown or shrunk to fit.
    points : int
        Points on each loop; corners are among them.
    detail : int
        Steps of the grid across the box; a loop narrower than a step may be missed. Where two fields come so
        close that a step joins what does not touch, they have no corner there, and the grid is refined.

    Raises
    ------
    InputError
        Parts come closer than the finest grid tells apart.
    """
    for finer in _FINER:
        try:
            every = [_arcs(cut, ring) for ring in _rings(cut, box, finer * detail)]
        except _NoCornerError:
            continue
        return oriented(_told_once([_loop(cut, arcs, points) for arcs in every if arcs]))
    raise InputError(
        "two parts of the body all but touch on a section",
        found=f"z = {cut.z:g} mm",
        fix="give another number of --sections, or another --placing",
    )


class _NoCornerError(Exception):
    """Two fields are nowhere both zero near where one takes over from the other."""


def _told_once(loops: Sequence[Loop]) -> list[Loop]:
    """Return the loops less repeated ones: a lens thinner than a grid step comes in crumbs."""
    kept: list[Loop] = []
    for loop in loops:
        reach = float(np.ptp(loop.points, axis=0).max())
        same = [
            other
            for other in kept
            if abs(abs(other.signed_area) - abs(loop.signed_area)) < _SAME * reach**2
            and np.abs(other.points.mean(axis=0) - loop.points.mean(axis=0)).max() < _SAME * reach
        ]
        if abs(loop.signed_area) > _SAME * reach**2 and not same:
            kept.append(loop)
    return kept


def _rings(cut: PlaneCut, box: tuple[FloatArray, FloatArray], detail: int) -> list[FloatArray]:
    """Return closed polylines (2, k), last point not repeated, near the boundary."""
    low, high = box
    rings: list[FloatArray] = []
    for _ in range(_FITS):
        rings, cut_off = _grid_rings(cut, low, high, detail)
        if cut_off:
            low, high = low - 0.3 * (high - low), high + 0.3 * (high - low)
            continue
        if not rings:
            return []
        least = np.min([ring.min(axis=1) for ring in rings], axis=0)
        most = np.max([ring.max(axis=1) for ring in rings], axis=0)
        if (most - least > (high - low) / 2).all():
            break
        margin = 0.1 * (most - least).max()
        low, high = least - margin, most + margin
    return rings


def _grid_rings(
    cut: PlaneCut, low: FloatArray, high: FloatArray, detail: int
) -> tuple[list[FloatArray], bool]:
    """Return the rings found on a grid over a rectangle, and whether its border cuts the section off."""
    from skimage.measure import find_contours  # noqa: PLC0415 - heavy, and not needed by polyhedra

    x, y = (np.linspace(low[axis], high[axis], detail) for axis in (0, 1))
    X, Y = np.meshgrid(x, y, indexing="ij")
    field = cut.worst(np.stack([X.ravel(), Y.ravel()]))[0].reshape(X.shape)
    cell = (high - low) / (detail - 1)
    rings = [(low + cell * ring[:-1]).T for ring in find_contours(field, 0.0)]  # type: ignore[no-untyped-call]
    border = np.concatenate([field[0], field[-1], field[:, 0], field[:, -1]])
    return [ring for ring in rings if ring.shape[1] >= 3], bool((border <= 0).any())


def _arcs(cut: PlaneCut, ring: FloatArray) -> list[_Arc]:
    """Return the ring's arcs in order, each on one field, corners solved."""
    pieces = cut.nearest(ring)
    changes = np.flatnonzero(pieces != np.roll(pieces, 1))
    if not len(changes):
        ring = cut.project(ring, int(pieces[0]))
        return [_Arc(int(pieces[0]), np.append(ring, ring[:, :1], axis=1))]
    ring, pieces = np.roll(ring, -changes[0], axis=1), np.roll(pieces, -changes[0])
    starts = np.append(changes - changes[0], len(pieces))
    runs = [(int(pieces[a]), _settled(cut, ring[:, a:b], int(pieces[a]))) for a, b in pairwise(starts)]
    between = []
    for (piece, _), (following, _), last in zip(runs, runs[1:] + runs[:1], starts[1:], strict=True):
        between.append(_corners(cut, piece, following, (ring[:, last - 1] + ring[:, last % len(pieces)]) / 2))
    arcs = []
    for i, (piece, run) in enumerate(runs):
        arcs.append(_Arc(piece, np.column_stack([between[i - 1][-1][1], run, between[i][0][1]])))
        ends = between[i]
        arcs += [_Arc(a[0], np.column_stack([a[1], b[1]])) for a, b in pairwise(ends)]
    return _without_slivers(cut, arcs)


def _settled(cut: PlaneCut, run: FloatArray, piece: int) -> FloatArray:
    """Return the run's points moved onto its field, less those that fall beyond another one."""
    moved = cut.project(run, piece)
    return moved[:, cut.worst(moved)[1] == piece]


def _corners(
    cut: PlaneCut, first: int, second: int, near: FloatArray, depth: int = 0
) -> list[tuple[int, FloatArray]]:
    """Return [(field after the corner, corner)] from `first` to `second`, passing fields hidden between."""
    corner = cut.meet(first, second, near)
    if max(cut.away(field, corner) for field in (first, second)) > _MET * cut.size:
        raise _NoCornerError
    value, piece = cut.worst(corner[:, None])
    hidden = int(piece[0])
    slope = np.hypot(*cut.values_and_gradients(hidden, corner[:, None])[1][:, 0])
    if depth > 3 or hidden in {first, second} or abs(value[0]) <= _TINY * cut.size * slope:
        return [(second, corner)]
    return _corners(cut, first, hidden, corner, depth + 1) + _corners(cut, hidden, second, corner, depth + 1)


def _without_slivers(cut: PlaneCut, arcs: Sequence[_Arc]) -> list[_Arc]:
    """Return the arcs less those of no length, and neighbours on one field joined."""
    kept: list[_Arc] = []
    for arc in arcs:
        if arc.length <= _TINY * cut.size:
            continue
        if kept and kept[-1].piece == arc.piece:
            kept[-1] = _Arc(arc.piece, np.column_stack([kept[-1].points, arc.points[:, 1:]]))
        else:
            kept.append(arc)
    if len(kept) > 1 and kept[0].piece == kept[-1].piece:
        last = kept.pop()
        kept[0] = _Arc(last.piece, np.column_stack([last.points, kept[0].points[:, 1:]]))
    return kept


def _loop(cut: PlaneCut, arcs: Sequence[_Arc], points: int) -> Loop:
    """Return the loop with points spread along its arcs; arc joints are corners."""
    total = sum(arc.length for arc in arcs)
    spread = [_spread(cut, arc, max(2, round(points * arc.length / total))) for arc in arcs]
    starts = np.cumsum([0] + [part.shape[1] for part in spread[:-1]])
    corners = frozen_ints(starts if len(arcs) > 1 else [])
    return Loop(frozen_floats(np.column_stack(spread).T), corners)


def _spread(cut: PlaneCut, arc: _Arc, count: int) -> FloatArray:
    """Return `count` points of the arc by equal arc length, its last end left out, (2, count)."""
    line = arc.points
    for _ in range(_SPREADS):
        s = np.append(0.0, np.cumsum(np.hypot(*np.diff(line))))
        targets = np.linspace(0, s[-1], count + 1)
        line = np.stack([np.interp(targets, s, axis) for axis in line])
        line[:, 1:-1] = cut.project(line[:, 1:-1], arc.piece)
    return line[:, :-1]
