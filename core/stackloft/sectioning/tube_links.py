"""Which loops of one level lead to which of the next, and in which steps where they part or meet."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from scipy.interpolate import PchipInterpolator

from stackloft.model.notices import Notice
from stackloft.sectioning.level_changes import (
    Joined,
    Straight,
    joint_of,
    levels_between,
    narrows,
    steps_between,
)
from stackloft.sectioning.levels import Level, covered, is_hole, part_level
from stackloft.sectioning.line_parting import Parting, parting_levels
from stackloft.sectioning.link_notices import (
    apart_notice,
    carried_far,
    chosen_notice,
    link_numbers,
    tangle,
    turned_notice,
    weak_notice,
)
from stackloft.sectioning.loop_links import LinkedLoops, components, link_loops, simpler_links
from stackloft.sectioning.loop_numbers import Links, numbered_links
from stackloft.sectioning.lying_limbs import limbs_cut_off
from stackloft.sectioning.section_regions import Regions, section_regions


@dataclass(frozen=True, slots=True, eq=False)
class Change:
    """Steps through a gap in which loops part, meet, or close round a hole."""

    linked: LinkedLoops
    levels: tuple[Level, ...]
    """From the one section to the other, those put in between."""
    steps: tuple[Straight | Joined, ...]


Linked = tuple[LinkedLoops, Change | None]


class LinkFinder:
    """Finds the links of a stack of levels.

    What it had to choose is in `notices`; sections after which limbs could be cut off, in `limbs`.
    """

    def __init__(
        self, levels: list[Level], said: Mapping[str, Links], cut: frozenset[int] = frozenset()
    ) -> None:
        self.notices: list[Notice] = []
        self.limbs: set[int] = set()
        self._said = said
        self._cut = cut
        self._real = [level for level in levels if level.section is not None]
        z = [level.z for level in self._real]
        areas = [covered(level) for level in self._real]
        self._areas = PchipInterpolator(z, areas) if len(z) > 1 else None

    def area(self, z: float) -> float:
        """Return the area of all loops at z, mm², from the sections' areas."""
        return float(self._areas(z)) if self._areas is not None else 0.0

    def _from_section(self, level: Level, *, away_from: Level) -> tuple[Level, ...]:
        """Return the section of a level, whole, and those beyond it as seen from another level."""
        outwards = self._real if level.z > away_from.z else self._real[::-1]
        return tuple(other for other in outwards if (other.z - level.z) * (level.z - away_from.z) >= 0.0)

    def links(self, before: Level, after: Level) -> list[Linked]:
        """Return how the loops hang together and, where they part or meet, in which steps."""
        regions = _regions(before), _regions(after)
        said = self._said.get(before.name) if before.section is not None is not after.section else None
        if said is not None:
            pairs = numbered_links(said, before.polygons, after.polygons, (before.name, after.name))
            every = components(pairs, *regions, set())
        else:
            every = link_loops(*regions)
        if said is None and _come_and_go(before, after, every):
            self.notices.append(apart_notice(before, after))
        found: list[Linked] = []
        for linked in every:
            if linked.weak:
                self.notices.append(weak_notice(before.name, after.name, link_numbers(before, after, linked)))
            planned = self._planned(before, after, linked)
            if planned is None and said is None:
                planned = self._untangled(before, after, linked, regions)
            if planned is None:
                raise tangle(before, after, linked)
            found += planned
        return found

    def _planned(self, before: Level, after: Level, linked: LinkedLoops) -> list[Linked] | None:
        """Return the links with the steps of a change; None where no steps lead through it."""
        if not linked.before or not linked.after:
            return [(linked, None)]
        if linked.plain:
            if before.section is not None is not after.section and not linked.weak:
                one, two = before.polygons[linked.before[0]], after.polygons[linked.after[0]]
                if not is_hole(one) and carried_far(one, two):
                    self.notices.append(turned_notice(before.name, after.name))
            return [(linked, self._limbs(before, after, linked))]
        change = self._change(before, after, linked)
        if change is None:
            return None
        straight = [step for step in change.steps if isinstance(step, Straight)]
        if len(straight) == len(change.steps) and before.section is not None:  # nothing parts or meets
            followed = list(range(len(linked.before)))
            for step in straight:
                followed = [followed[k] for k in step.order]
            pairs = [
                LinkedLoops((linked.before[i],), (j,)) for i, j in zip(followed, linked.after, strict=True)
            ]
            self.notices.append(chosen_notice(before, after, pairs))
        return [(linked, change)]

    def _untangled(
        self, before: Level, after: Level, linked: LinkedLoops, regions: tuple[Regions, Regions]
    ) -> list[Linked] | None:
        """Return the first simpler way in which the loops can be joined, and tell of the choice."""
        for simpler in simpler_links(*regions, linked):
            plans = [self._planned(before, after, one) for one in simpler]
            if all(plan is not None for plan in plans):
                self.notices.append(chosen_notice(before, after, simpler))
                return [item for plan in plans for item in plan or []]
        return None

    def _change(self, before: Level, after: Level, linked: LinkedLoops) -> Change | None:
        """Return the steps through a change of topology; None when there are none."""
        one, two = part_level(before, linked.before), part_level(after, linked.after)
        put_in: list[Level] = []
        trial = [joint_of(one, two)]
        if before.section is not None and after.section is not None:  # else they were put in already
            put_in = levels_between(one, two, self.part_area(before, after, one, two))
            trial = steps_between(one, put_in, two)
        if any(t is None for t in trial) or (put_in and not narrows(trial, joint_of(one, two))):
            put_in, trial = self._along_a_line(one, two)
        steps = tuple(step for step in trial if step is not None)
        return Change(linked, (one, *put_in, two), steps) if len(steps) == len(trial) else None

    def _along_a_line(self, one: Level, two: Level) -> tuple[list[Level], list[Straight | Joined | None]]:
        """Return levels put in where a piece parts along a line, none elsewhere, and how they follow."""
        direct: tuple[list[Level], list[Straight | Joined | None]] = ([], [joint_of(one, two)])
        whole, parted = sorted((one, two), key=lambda level: len(level.loops))
        if len(whole.loops) != 1 or len({is_hole(p) for p in (*whole.polygons, *parted.polygons)}) != 1:
            return direct
        put_in = parting_levels(Parting(whole, parted, self._from_section(parted, away_from=whole)))
        if whole is two:
            put_in = put_in[::-1]
        trial = steps_between(one, put_in, two)
        return (put_in, trial) if all(t is not None for t in trial) else direct

    def _limbs(self, before: Level, after: Level, linked: LinkedLoops) -> Change | None:
        """Return the step by which a section's loop goes on as the next one's once its limbs are cut off."""
        if before.section is None or after.section is None:
            return None
        one, two = part_level(before, linked.before), part_level(after, linked.after)
        step = limbs_cut_off(one, two)
        if step is None:
            return None
        self.limbs.add(before.section)
        return Change(linked, (one, two), (step,)) if before.section in self._cut else None

    def part_area(self, before: Level, after: Level, one: Level, two: Level) -> Callable[[float], float]:
        """Return the area of the loops that change, mm², at t in [0, 1] between two sections.

        What all sections' areas say, less the other loops' share.
        """
        ends = covered(one), covered(two)
        others = covered(before) - ends[0], covered(after) - ends[1]
        sign = 1.0 if ends[0] + ends[1] > 0.0 else -1.0
        low, high = sorted(sign * end for end in ends)

        def area(t: float) -> float:
            whole = self.area(one.z + t * (two.z - one.z))
            own = sign * (whole - (1.0 - t) * others[0] - t * others[1])
            return min(max(own, 0.7 * low), 1.4 * high)

        return area


def _regions(level: Level) -> Regions:
    return section_regions(list(level.polygons), level.name)


def _come_and_go(before: Level, after: Level, every: list[LinkedLoops]) -> bool:
    """Return whether one piece ends and another begins between two sections."""
    if before.section is None or after.section is None:
        return False
    gone = any(not is_hole(before.polygons[i]) for one in every if not one.after for i in one.before)
    new = any(not is_hole(after.polygons[j]) for one in every if not one.before for j in one.after)
    return gone and new
