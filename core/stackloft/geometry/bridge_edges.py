"""Loops cut along chords, as edges that both sides of the cut share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Vertex = tuple[int, int]
"""Loop and vertex."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """One loop after cutting."""

    points: FloatArray
    """(k, 2) mm"""
    pinned: IntArray
    """(c,) vertices at which edges meet"""
    edges: tuple[tuple[int, bool], ...]
    """(edge, forward) from pinned vertex to pinned vertex, beginning at the first"""


@dataclass(frozen=True, slots=True, eq=False)
class BridgeCut:
    """Loops before and after cutting, made of the same edges."""

    edges: tuple[FloatArray, ...]
    """(k, 2) mm: polylines, ends included"""
    wholes: tuple[Part, ...]
    parts: tuple[Part, ...]


@dataclass(slots=True)
class CutLine:
    """A loop while it is cut: where each vertex comes from, and which chord leaves it."""

    points: FloatArray
    source: IntArray
    """(k, 2): loop and vertex that each vertex was"""
    chord: IntArray
    """(k,) 0: an edge of its own loop leaves the vertex; ±(c + 1): chord c, forward or backward"""


def source(line: CutLine, vertex: int) -> tuple[int, int]:
    """Return the loop and the vertex that a vertex was before cutting."""
    return int(line.source[vertex, 0]), int(line.source[vertex, 1])


def _chord(start: FloatArray, end: FloatArray, loop: FloatArray) -> FloatArray:
    """Return a chord with points as far apart as the loop's."""
    side = float(np.linalg.norm(np.diff(loop, axis=0), axis=1).mean())
    parts = max(1, round(float(np.linalg.norm(end - start)) / side))
    return np.asarray(start + (np.arange(parts + 1) / parts)[:, None] * (end - start))


def assembled(
    joined: list[FloatArray], lines: list[CutLine], chords: list[tuple[tuple[int, int], tuple[int, int]]]
) -> BridgeCut:
    """Return edges, wholes and parts once all chords are drawn."""
    pins = {end for chord in chords for end in chord}
    edges: list[FloatArray] = []
    number: dict[tuple[int, int], int] = {}  # pinned vertex that an arc leaves → edge
    wholes = []
    for w, points in enumerate(joined):
        own = sorted(v for loop, v in pins if loop == w)
        if not own:
            own = [0]
        first = len(edges)
        for v, after in zip(own, [*own[1:], own[0] + len(points)], strict=True):
            number[w, v] = len(edges)
            edges.append(points[np.arange(v, after + 1) % len(points)])
        uses = tuple((k, True) for k in range(first, len(edges)))
        wholes.append(Part(points, np.array(own), uses))
    arcs = len(edges)
    edges += [_chord(joined[a][i], joined[b][j], joined[a]) for (a, i), (b, j) in chords]
    parts = []
    for line in lines:
        at = [k for k in range(len(line.points)) if source(line, k) in number]
        uses = tuple(
            (number[source(line, k)], True)
            if line.chord[k] == 0
            else (arcs + abs(int(line.chord[k])) - 1, int(line.chord[k]) > 0)
            for k in at
        )
        parts.append(Part(line.points, np.array(at), uses))
    return BridgeCut(tuple(edges), tuple(wholes), tuple(parts))
