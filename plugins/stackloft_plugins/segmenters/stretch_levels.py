r"""The level at the body's edge, stretch by stretch of the outline, where the ground beside it is not even.

::

     ____          Bands beside a boundary that lies a little outside see other grey levels than beside one
    /    \__       a little inside: on ground that slopes, half-way between the bands holds for many levels,
    |      :\      and which of them is found is chance. The profile across the edge, a model of which knows
    \______/:      the slope (`geometry.edge_positions`), tells where the edge is, and the level there.
      stretch

One level for the whole outline may run far from the edge in a shadow; therefore three times, each about the
boundary that the last one's levels give.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stackloft.geometry.edge_positions import EdgeShape, edge_positions
from stackloft.model.arrays import FloatArray, IntArray
from stackloft_plugins.segmenters.across_edge import ACROSS, REACH, Across, across
from stackloft_plugins.segmenters.body_outline import outline_in
from stackloft_plugins.segmenters.cell_means import CellMeans, cell_means
from stackloft_plugins.segmenters.grey import Grey, Levels

UNEVEN = 0.05
"""Of the step: standard deviation along the outline of what lies beside it, above which it is not even."""
_POINTS = 20
"""Boundary pixels in a stretch, at least."""
_STRETCHES = (8, 60)
_OVERLAP = 1.5
"""Of its length: what a stretch takes from its neighbours."""
_POOREST = 0.03
"""Misfit, as a fraction of the step, of a profile that the model does not describe."""
_BELIEVED = 0.6
"""Share of the stretches that the model must describe."""
_OTHERWISE = 0.3
"""Of the contrast: what is so far on the wrong side of the level, further than `_CLEAR` pixels from it, is a
reflection on the flesh or a crumb beside it."""
_CLEAR = 2.5
_FEWEST = 6
"""Rows of a stretch that show neither."""
_SLACKS = (0.5, 0.25, 0.1)
"""Pixels by which neighbouring stretches' edges usually differ, time after time."""
_FURTHEST = 0.35
"""Of the usual step: no level is further from the one level."""
_SMOOTH = 6.0
"""Pixels: standard deviation of the window in which the levels along the outline are carried to its sides."""
_TRUST = 1e-6


def stretch_levels(grey: Levels, contrast: float, level: float, seen: Across) -> CellMeans | None:
    """Return the level all over the picture.

    Returns None when what lies beside the outline is even, when it is short, lies at the border, or has
    edges unlike the model.

    Parameters
    ----------
    grey : array (rows, columns)
        Body above background.
    contrast : float
        Step across the boundary.
    level : float
        The one level.
    seen : Across
        What is seen across the boundary at that level.
    """
    shape = (grey.shape[0], grey.shape[1])
    found: CellMeans | None = None
    lens: EdgeShape | None = None
    for slack in _SLACKS:
        about = seen if found is None else across(grey, outline_in(found.below(grey)), 0.0, found)
        step, more = _along(about, level if found is None else 0.0, contrast, slack, lens)
        if more is None:
            return None
        lens = more.lens
        moved = cell_means(shape, _numbers(more.points, shape), more.levels, _SMOOTH, _TRUST).cells
        moved += np.float32(level) if found is None else found.cells
        found = CellMeans(np.clip(moved, level - _FURTHEST * step, level + _FURTHEST * step), shape)
    return found


@dataclass(frozen=True, slots=True, eq=False)
class _Along:
    """What was seen along an outline."""

    points: FloatArray
    """(n, 2) x, y on the boundary at the level"""
    levels: FloatArray
    """(n) grey level above it at the edge beside each"""
    lens: EdgeShape


def _along(
    about: Across, level: float, contrast: float, slack: float, lens: EdgeShape | None
) -> tuple[float, _Along | None]:
    """Return the usual step, and what was seen; None where there is nothing to follow."""
    points = about.points
    if about.looked_for < _POINTS * _STRETCHES[0] // 2 or len(points) < 0.5 * about.looked_for:
        return 0.0, None
    seen = about.levels - np.float32(level)
    count = int(np.clip(len(points) // _POINTS, *_STRETCHES))
    stretches = [_clean(stretch, _OTHERWISE * contrast) for stretch in _stretches(seen, count)]
    profiles = np.stack([_usual(stretch) for stretch in stretches])
    seen_well = (profiles[:, 0] > profiles[:, -1]) & [len(stretch) >= _FEWEST for stretch in stretches]
    step = _step(profiles[seen_well])
    if seen_well.mean() < _BELIEVED or not _uneven(profiles[seen_well], step):
        return step, None
    found = edge_positions(profiles, REACH, slack, lens)
    chosen = np.flatnonzero(seen_well & (found.misfit < _POOREST))
    if len(chosen) < _BELIEVED * count or not _uneven(profiles[chosen], _step(profiles[chosen])):
        return step, None
    levels = np.array([np.interp(found.position[k], ACROSS, profiles[k]) for k in chosen])
    calm = np.median([np.roll(levels, 1), levels, np.roll(levels, -1)], axis=0)
    along = (np.arange(len(points)) + 0.5) / len(points)
    beside = np.interp(along, (chosen + 0.5) / count, calm, period=1.0)
    return _step(profiles[chosen]), _Along(points, beside, found.shape)


def _step(profiles: FloatArray) -> float:
    """Return the usual step from body to ground."""
    return float(np.median(profiles[:, 0] - profiles[:, -1])) if len(profiles) else 0.0


def _uneven(profiles: FloatArray, step: float) -> bool:
    """Return whether what lies beside the outline changes along it."""
    return float(profiles[:, ACROSS > 1.5].std(axis=0).max()) >= UNEVEN * step


def _stretches(seen: Grey, count: int) -> list[Grey]:
    """Return the rows of each stretch of a closed outline."""
    n = len(seen)
    half = 0.5 * _OVERLAP * n / count
    middles = (np.arange(count) + 0.5) * n / count
    return [seen[np.arange(int(m - half), int(m + half)) % n] for m in middles]


def _clean(stretch: Grey, least: float) -> Grey:
    """Return the rows that show flesh on one side and plate on the other; too few to count where few do."""
    flesh = (stretch[:, ACROSS < -_CLEAR] > -least).all(axis=1)
    plate = (stretch[:, ACROSS > _CLEAR] < least).all(axis=1)
    clean = stretch[flesh & plate]
    return clean if len(clean) >= _FEWEST else stretch[: _FEWEST - 1]


def _usual(stretch: Grey) -> FloatArray:
    """Return the mean of the middle half at each distance: crumbs and reflections do not count."""
    ordered = np.sort(stretch, axis=0)
    quarter = len(ordered) // 4
    return np.asarray(ordered[quarter : len(ordered) - quarter].mean(axis=0), dtype=np.float64)


def _numbers(points: FloatArray, shape: tuple[int, int]) -> IntArray:
    """Return the pixels, numbered row after row, that points (x, y) lie in, (n)."""
    column, row = np.clip(np.round(points), 0, np.array(shape[::-1]) - 1).T.astype(np.int64)
    return np.asarray(row * shape[1] + column)
