"""Corners followed from section to section, so that each becomes one column of the loft."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stackloft.model.arrays import FloatArray, IntArray

PERSISTENT = 0.2
"""Share of the sections on which a corner must show."""
APART = 1.0 / 3.0
"""Smallest distance of two corners as a fraction of the points' even spacing."""
REACH = 0.07
"""Corners of neighbouring sections belong together when closer than this fraction of the loop."""
FARTHEST = 0.25
"""Fraction of the loop beyond which they never do."""


@dataclass(frozen=True, slots=True, eq=False)
class CornerChain:
    """One corner through a run of sections."""

    at: dict[int, float]
    """Section number to the corner's place, a fraction of the loop from the seam, not wrapped."""

    @property
    def mean(self) -> float:
        """Mean place as a fraction of the loop in [0, 1); at the seam 0, whichever way rounding goes."""
        return round(float(np.mean(list(self.at.values()))) % 1.0, 12) % 1.0


def follow_corners(
    corners: list[FloatArray],
    count: int,
    kept: frozenset[int] = frozenset(),
    reach: FloatArray | None = None,
    places: list[FloatArray] | None = None,
    pitches: FloatArray | None = None,
) -> list[CornerChain]:
    """Return the corner chains of a stack in order round the loop.

    Parameters
    ----------
    corners : list of (c_i,) arrays
        Corner places of each section as fractions of the loop from its seam, in [0, 1).
    count : int
        Points per loop. At most half of them become corners, the longest chains first, and no two come
        closer on any section than a third of the even spacing.
    kept : frozenset of int
        Sections whose corners are never noise.
    reach : (m - 1,) array, optional
        Fraction of the loop within which corners of a section and the next belong together; `REACH` if
        not given.
    places : list of (c_i, 2) arrays, optional
        The corners in their planes, mm, and with `pitches`, (m - 1,) mm: those no farther apart than the
        sections belong together as well, within `FARTHEST` of the loop. Where a limb grows out of a body its
        loop becomes longer in one place, and the limb's corners move by more of it than in space.

    Returns
    -------
    list of CornerChain
        A corner that shows on fewer than a fifth of the sections, or on one alone, is taken for noise.
        Chains that would cross or meet on any section become one column where they show on different
        sections (the pins of joints at both ends of a tube), else the longer one stays.
    """
    chains: list[dict[int, float]] = []
    active: list[dict[int, float]] = []
    within = np.full(len(corners), REACH) if reach is None else np.concatenate([[REACH], reach])
    for section, marks in enumerate(corners):
        near = np.zeros((len(marks), len(active)), dtype=bool)
        if section and places is not None and pitches is not None:
            apart = np.linalg.norm(places[section][:, None] - places[section - 1][None], axis=2)
            near = apart <= pitches[section - 1]
        active = _extend(active, section, marks, chains, np.where(near, FARTHEST, within[section]))
    least = max(min(2, len(corners)), math.ceil(PERSISTENT * len(corners)))
    long_enough = [CornerChain(chain) for chain in chains if len(chain) >= least or kept & chain.keys()]
    longest = sorted(
        long_enough, key=lambda chain: (not kept & chain.at.keys(), -len(chain.at), round(chain.mean, 9))
    )[: count // 2]
    return _uncrossed(longest, len(corners), APART / count)


def _extend(
    active: list[dict[int, float]],
    section: int,
    marks: FloatArray,
    chains: list[dict[int, float]],
    within: FloatArray,
) -> list[dict[int, float]]:
    """Append the section's corners to the nearest active chains, or begin new ones."""
    away = np.array([[abs(_wrapped(mark - chain[section - 1])) for chain in active] for mark in marks])
    following: dict[int, dict[int, float]] = {}
    taken: set[int] = set()
    for flat in np.argsort(away, axis=None, kind="stable"):  # the closest pair first: a joint's pin beside
        i, k = divmod(int(flat), len(active))  # a corner must not take its column
        if i in following or k in taken or away[i, k] >= within[i, k]:
            continue
        taken.add(k)
        before = active[k][section - 1]
        active[k][section] = before + _wrapped(float(marks[i]) - before)
        following[i] = active[k]
    for i, mark in enumerate(marks):
        if i not in following:
            following[i] = {section: float(mark)}
            chains.append(following[i])
    return [following[i] for i in range(len(marks))]


def _wrapped(difference: float) -> float:
    """Return a difference of fractions in [-½, ½)."""
    return float((difference + 0.5) % 1.0 - 0.5)


def _uncrossed(chains: list[CornerChain], sections: int, apart: float) -> list[CornerChain]:
    """Return the chains, longest first to stay, that keep one cyclic order and distance on all sections."""
    kept: list[CornerChain] = []
    for chain in chains:
        for others, one in [(kept, chain), *_joined(kept, chain)]:
            trial = sorted([*others, one], key=lambda c: c.mean)
            if _in_order(trial, sections, apart):
                kept = trial
                break
    return kept


def _joined(kept: list[CornerChain], chain: CornerChain) -> list[tuple[list[CornerChain], CornerChain]]:
    """Return the ways in which a chain goes on in one of those kept, nearest first: (the others, the one)."""
    ways = []
    for other in kept:
        apart = _wrapped(chain.mean - other.mean)
        if abs(apart) < REACH and not other.at.keys() & chain.at.keys():
            turns = round(float(np.mean(list(other.at.values())) + apart - np.mean(list(chain.at.values()))))
            at = {**other.at, **{k: place + turns for k, place in chain.at.items()}}
            ways.append((abs(apart), [c for c in kept if c is not other], CornerChain(at)))
    return [(others, one) for _, others, one in sorted(ways, key=lambda way: way[0])]


def _in_order(chains: list[CornerChain], sections: int, apart: float) -> bool:
    """Return whether the chains' places at every section increase over less than one turn."""
    if len(chains) == 1:
        return True
    places = np.stack([places_of(chain, np.arange(sections)) for chain in chains])
    gaps = np.mod(np.roll(places, -1, axis=0) - places, 1.0)
    return bool((gaps.min(axis=0) > apart).all() and (np.abs(gaps.sum(axis=0) - 1.0) < 1e-6).all())


def places_of(chain: CornerChain, sections: IntArray) -> FloatArray:
    """Return the chain's places at any sections: between and beyond its own by interpolation."""
    known = sorted(chain.at)
    return np.asarray(np.interp(sections, known, [chain.at[k] for k in known]))


def share_points(chains: list[CornerChain], count: int) -> list[int]:
    """Return how many of `count` points each stretch from one chain to the next receives.

    Every stretch gets at least one; the rest in proportion to its length (largest remainders; lengths
    equal within 1e-6 are served in order, so that rounding decides nothing).

    Examples
    --------
    >>> share_points([CornerChain({0: q / 4}) for q in range(4)], 33)
    [9, 8, 8, 8]
    """
    places = [chain.mean for chain in chains]
    gaps = np.array([(b - a) % 1.0 or 1.0 for a, b in zip(places, [*places[1:], places[0]], strict=True)])
    ideal = np.maximum(gaps / gaps.sum() * count, 1.0)
    shares = np.floor(ideal + 1e-6).astype(int)
    order = sorted(range(len(gaps)), key=lambda k: (-round(float(ideal[k] - shares[k]), 6), k))
    for k in order * (count // len(gaps) + 1):
        if shares.sum() == count:
            break
        if shares.sum() < count:
            shares[k] += 1
        elif shares[k] > 1:
            shares[k] -= 1
    return [int(share) for share in shares]
