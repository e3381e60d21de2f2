r"""Cut plane loops along chords, so that they become the loops of a neighbouring section.

::

      .----.  .----.        one loop, cut along p–q: two loops;
     (      p       )       a ring, cut from its outline to its hole:
      '----' q'----'        one loop that runs round both

Loops keep the body on their left: outlines counter-clockwise, holes clockwise.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates
from scipy.spatial import cKDTree

from stackloft.geometry.bridge_edges import BridgeCut, CutLine, assembled, source
from stackloft.geometry.equal_choices import EQUAL, chords_ahead, least_of
from stackloft.geometry.plane_nodes import centred_nodes
from stackloft.geometry.polygon_distance import signed_distance
from stackloft.geometry.shoelace import polygon_area

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

CANDIDATES = 400
"""Vertices of a loop between which chords are tried, at most: all, so that no start point decides."""
FEWER = 80
"""The same where loops fall into many parts: a jagged outline's, not a branch's."""
MANY = 3
MOST = 12
"""More cuts than this in one step are no body's: crumpled outlines fall apart like that."""
SAMPLES = 9
FEWEST = 2
ASTRAY = 4.0
"""What a chord costs, in lengths, where it runs through the neighbour's body or leaves its own."""
MISLAID = 0.5
"""What a length of outline costs that ends up with a farther part of the neighbour."""


def cut_bridges(
    joined: list[FloatArray], parted: list[FloatArray], splits: int, merges: int
) -> BridgeCut | None:
    """Cut loops until they have the topology of the neighbour's.

    Parameters
    ----------
    joined : list of (k, 2) arrays
        The loops to cut, mm, body on the left.
    parted : list of (k, 2) arrays
        The loops of the neighbouring section that they should become.
    splits, merges : int
        How often a loop is to be cut in two, and how often two loops are to be made one.

    Returns
    -------
    BridgeCut or None
        None when no chord does it, or more than `MOST` were needed.
    """
    if splits + merges > MOST:
        return None
    lines = [_line(p, w) for w, p in enumerate(joined)]
    cost = _ChordCost(joined, parted, CANDIDATES if splits + merges < MANY else FEWER)
    chords: list[tuple[tuple[int, int], tuple[int, int]]] = []
    for kind in ["merge"] * merges + ["split"] * splits:
        found = cost.best_merge(lines) if kind == "merge" else cost.best_split(lines)
        if found is None:
            return None
        a, i, b, j = found
        chords.append((source(lines[a], i), source(lines[b], j)))
        made = (
            _split(lines[a], i, j, len(chords)) if a == b else [_merge(lines[a], i, lines[b], j, len(chords))]
        )
        lines = [line for k, line in enumerate(lines) if k not in {a, b}] + made
    return assembled(joined, lines, chords)


def cut_off(loop: FloatArray, runs: list[tuple[int, int]]) -> BridgeCut:
    """Cut stretches of a loop off, each along the chord from its first vertex to its last.

    Parameters
    ----------
    loop : (k, 2) array
        Polygon, mm, body on the left.
    runs : list of (first, last)
        Vertices; no two stretches overlap.

    Returns
    -------
    BridgeCut
        Its parts are the stretches in order, and last what is left of the loop.
    """
    rest, parts = _line(loop, 0), []
    for number, ends in enumerate(runs, start=1):
        i, j = (int(np.flatnonzero(rest.source[:, 1] == end)[0]) for end in ends)
        part, rest = _split(rest, i, j, number)
        parts.append(part)
    return assembled([loop], [*parts, rest], [((0, first), (0, last)) for first, last in runs])


def _line(loop: FloatArray, number: int) -> CutLine:
    """Return a loop not yet cut."""
    source_of = np.column_stack([np.full(len(loop), number), np.arange(len(loop))])
    return CutLine(loop, source_of, np.zeros(len(loop), dtype=np.int64))


def _split(line: CutLine, i: int, j: int, chord: int) -> list[CutLine]:
    """Return the two loops on both sides of a chord from vertex i to vertex j."""
    n = len(line.points)
    made = []
    for a, b, sign in ((i, j, -1), (j, i, 1)):
        run = np.arange(a, (b if b > a else b + n) + 1) % n
        leaving = line.chord[run].copy()
        leaving[-1] = sign * chord
        made.append(CutLine(line.points[run], line.source[run], leaving))
    return made


def _merge(one: CutLine, i: int, two: CutLine, j: int, chord: int) -> CutLine:
    """Return the one loop that runs round both, and along the chord to and fro."""
    first = (np.arange(len(one.points) + 1) + i) % len(one.points)
    second = (np.arange(len(two.points) + 1) + j) % len(two.points)
    leaving = np.concatenate([one.chord[first], two.chord[second]])
    leaving[len(first) - 1] = chord
    leaving[-1] = -chord
    return CutLine(
        np.concatenate([one.points[first], two.points[second]]),
        np.concatenate([one.source[first], two.source[second]]),
        leaving,
    )


class _ChordCost:
    """What chords cost."""

    def __init__(self, joined: list[FloatArray], parted: list[FloatArray], candidates: int) -> None:
        self._candidates = candidates
        every = np.concatenate([*joined, *parted])
        low, high = every.min(axis=0), every.max(axis=0)
        self._size = float((high - low).max())
        self._step = self._size / 128.0
        x, y = centred_nodes(low, high, self._step, 2)
        self._origin = np.array([x[0], y[0]])
        self._own = signed_distance(x, y, _dense(joined, self._step))
        self._other = signed_distance(x, y, _dense(parted, self._step))
        self._trees = [cKDTree(p) for p in parted if polygon_area(p) > 0.0]

    def _price(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Return the cost of chords between points, (n, 2) each."""
        t = (np.arange(SAMPLES) + 0.5) / SAMPLES
        points = start[:, None] + t[:, None] * (end - start)[:, None]
        at = np.moveaxis((points - self._origin) / self._step, -1, 0)[::-1]
        through = map_coordinates(self._other, at, order=1, mode="nearest") > 0.0
        beyond = map_coordinates(self._own, at, order=1, mode="nearest") < -0.25 * self._step
        length = np.linalg.norm(end - start, axis=1)
        return np.asarray(length * (1.0 + ASTRAY * (through.mean(axis=1) + beyond.mean(axis=1))))

    def best_split(self, lines: list[CutLine]) -> tuple[int, int, int, int] | None:
        """Return (loop, vertex, loop, vertex) of the best chord that cuts a loop in two."""
        best, choice = np.inf, None
        for k, line in enumerate(lines):
            found = self._split_of(line)
            if found is not None and found[0] < best:
                best, choice = found[0], (k, found[1], k, found[2])
        return choice

    def _split_of(self, line: CutLine) -> tuple[float, int, int] | None:
        chosen = _spread(line, self._candidates)
        if len(chosen) < FEWEST or len(self._trees) < FEWEST:
            return None
        share = self._shares(line.points)
        total = share[-1]
        if (total > 0.0).sum() < 2:
            return None
        a, b = np.triu_indices(len(chosen), 1)
        i, j = chosen[a], chosen[b]
        inner = share[j] - share[i]
        mislaid = np.minimum(inner, total - inner).sum(axis=1)
        kinds = ((inner > 0.5 * total) & (total > 0.0)).sum(axis=1)
        cost = self._price(line.points[i], line.points[j]) + MISLAID * mislaid
        cost[(kinds == 0) | (kinds == (total > 0.0).sum())] = np.inf
        best = least_of(cost, chords_ahead(line.points[i], line.points[j]), self._size)
        return (float(cost[best]), int(i[best]), int(j[best])) if np.isfinite(cost[best]) else None

    def _shares(self, points: FloatArray) -> FloatArray:
        """Return how much of the line's first k sides lies nearest to each outline, (n + 1, outlines) mm.

        Half of a side goes by either end; a vertex half-way between two outlines is half the one's.
        """
        away = np.stack([tree.query(points)[0] for tree in self._trees], axis=1)
        nearest = away <= away.min(axis=1, keepdims=True) + EQUAL * self._size
        owner = nearest / nearest.sum(axis=1, keepdims=True)
        side = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
        own = 0.5 * side[:, None] * (owner + np.roll(owner, -1, axis=0))
        return np.concatenate([np.zeros((1, own.shape[1])), np.cumsum(own, axis=0)])

    def best_merge(self, lines: list[CutLine]) -> tuple[int, int, int, int] | None:
        """Return the best chord between two loops of which one at least is a hole."""
        best, choice = np.inf, None
        for p, one in enumerate(lines):
            for q, two in enumerate(lines[p + 1 :], start=p + 1):
                if polygon_area(one.points) > 0.0 and polygon_area(two.points) > 0.0:
                    continue
                a, b = np.meshgrid(
                    _spread(one, self._candidates), _spread(two, self._candidates), indexing="ij"
                )
                if not a.size:
                    continue
                i, j = a.ravel(), b.ravel()
                start, end = one.points[i], two.points[j]
                cost = self._price(start, end)
                k = least_of(cost, chords_ahead(start, end), self._size)
                if cost[k] < best:
                    best, choice = float(cost[k]), (p, int(i[k]), q, int(j[k]))
        return choice


def _spread(line: CutLine, candidates: int) -> IntArray:
    """Return vertices to try, evenly spread, none of them an end of an earlier chord."""
    free = np.flatnonzero((line.chord == 0) & (np.roll(line.chord, 1) == 0))
    stride = max(1, len(free) // candidates)
    return free[::stride]


def _dense(loops: list[FloatArray], step: float) -> list[FloatArray]:
    """Return polygons whose sides are no longer than a step."""
    result = []
    for points in loops:
        closed = np.concatenate([points, points[:1]])
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
        wanted = np.unique(np.concatenate([arc[:-1], np.arange(0.0, arc[-1], step)]))
        result.append(np.column_stack([np.interp(wanted, arc, closed[:, k]) for k in (0, 1)]))
    return result
