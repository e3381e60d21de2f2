"""Which loops of one section belong to which of the next."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.sectioning.section_regions import OUTSIDE, Regions, overlap, share_outside

BELONG = 0.3
"""Overlap, as a fraction of the smaller region, from which two regions are one."""
KNOT = 8
"""Links of a knot that is worth untangling."""
PERHAPS = 0.03
"""Overlap from which two regions that have no other partner are taken for one, with a warning."""


@dataclass(frozen=True, slots=True)
class LinkedLoops:
    """Loops of two neighbouring sections that are parts of one surface."""

    before: tuple[int, ...]
    after: tuple[int, ...]
    weak: bool = False
    """True when an overlap was below `BELONG`."""

    @property
    def plain(self) -> bool:
        """True for one loop that goes on as one loop."""
        return len(self.before) == len(self.after) == 1


def link_loops(before: Regions, after: Regions) -> list[LinkedLoops]:
    """Return how the loops of two neighbouring sections hang together.

    A loop without a partner comes alone: there its surface ends.

    Examples
    --------
    >>> from stackloft.sectioning.section_regions import section_regions
    >>> square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    >>> one = section_regions([square * [3, 1]])
    >>> two = section_regions([square + [-2, 0], square + [2, 0]])
    >>> link_loops(one, two)
    [LinkedLoops(before=(0,), after=(0, 1), weak=False)]
    """
    links, weak = _linked_pairs(before, after)
    return components(links, before, after, weak)


Pair = tuple[int, int]


def _linked_pairs(before: Regions, after: Regions) -> tuple[list[Pair], set[Pair]]:
    pieces, weak_pieces = _links(_overlaps(before, after, holes=False))
    hollows = _overlaps(before, after, holes=True)
    hollow_links, weak_hollows = _links(hollows)
    opened = _opened(before, after)
    weak = weak_pieces | weak_hollows
    links = [
        (i, j)
        for i in range(len(before.loops))
        for j in range(len(after.loops))
        if (before.piece(i), after.piece(j)) in pieces
        and _same_background(before.background(i), after.background(j), hollow_links, opened)
    ]
    return links, weak


def simpler_links(before: Regions, after: Regions, linked: LinkedLoops) -> Iterator[list[LinkedLoops]]:
    """Yield simpler ways in which the same loops may hang together, the weakest overlaps given up first.

    Loops that part and meet at once cannot be joined in one step. Without its least overlaps such a knot
    falls apart into loops that go on, part or meet.
    """
    links, weak = _linked_pairs(before, after)
    own = [(i, j) for i, j in links if i in linked.before and j in linked.after]
    if len(own) > KNOT:
        return
    share = {
        (i, j): overlap([before.loops[i]], [after.loops[j]]) if before.holes[i] == after.holes[j] else 1.0
        for i, j in own
    }
    for count in range(len(own) - 1, 0, -1):
        kept = sorted(own, key=lambda pair: -share[pair])[:count]
        yield [
            found
            for found in components(kept, before, after, weak)
            if set(found.before) <= set(linked.before) and set(found.after) <= set(linked.after)
        ]


def _overlaps(before: Regions, after: Regions, *, holes: bool) -> dict[Pair, float]:
    found = {}
    for i in np.flatnonzero(before.holes == holes):
        for j in np.flatnonzero(after.holes == holes):
            share = overlap(before.within(int(i)), after.within(int(j)))
            if share > PERHAPS:
                found[int(i), int(j)] = share
    return found


def _links(overlaps: dict[Pair, float]) -> tuple[set[Pair], set[Pair]]:
    """Return the pairs that belong together, and those among them that overlap little."""
    sure = {pair for pair, share in overlaps.items() if share >= BELONG}
    left, right = {i for i, _ in sure}, {j for _, j in sure}
    weak: set[Pair] = set()
    for (i, j), _ in sorted(overlaps.items(), key=lambda item: -item[1]):
        if i not in left and j not in right:
            weak.add((i, j))
            left.add(i)
            right.add(j)
    return sure | weak, weak


def _opened(before: Regions, after: Regions) -> set[Pair]:
    """Return the holes that lie outside the body on the other section, as pairs with OUTSIDE."""
    found: set[Pair] = set()
    for i in np.flatnonzero(before.holes):
        if share_outside(before.within(int(i)), after.outermost()) >= BELONG:
            found.add((int(i), OUTSIDE))
    for j in np.flatnonzero(after.holes):
        if share_outside(after.within(int(j)), before.outermost()) >= BELONG:
            found.add((OUTSIDE, int(j)))
    return found


def _same_background(i: int, j: int, links: set[Pair], opened: set[Pair]) -> bool:
    if i == OUTSIDE and j == OUTSIDE:
        return True
    return (i, j) in opened if OUTSIDE in {i, j} else (i, j) in links


def components(links: list[Pair], before: Regions, after: Regions, weak: set[Pair]) -> list[LinkedLoops]:
    """Return the connected sets of loops, in order of their first loop."""
    groups: list[tuple[set[int], set[int]]] = [({i}, set()) for i in range(len(before.loops))]
    groups += [(set(), {j}) for j in range(len(after.loops))]
    for i, j in links:
        one = next(g for g in groups if i in g[0])
        two = next(g for g in groups if j in g[1])
        if one is not two:
            groups.remove(two)
            one[0].update(two[0])
            one[1].update(two[1])
    return [
        LinkedLoops(
            tuple(sorted(a)),
            tuple(sorted(b)),
            any(
                (
                    before.background(i) if before.holes[i] else before.piece(i),
                    after.background(j) if after.holes[j] else after.piece(j),
                )
                in weak
                for i in a
                for j in b
            ),
        )
        for a, b in groups
    ]


def handles(regions: Regions, loops: tuple[int, ...]) -> int:
    """Return outer loops less holes: a bridge cut through adds one."""
    holes = int(regions.holes[list(loops)].sum())
    return len(loops) - 2 * holes


def bounding_box(loops: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return the least and greatest coordinates, (2,) mm each."""
    return np.min([p.min(axis=0) for p in loops], axis=0), np.max([p.max(axis=0) for p in loops], axis=0)
