"""What is done where a skin drawn straight from one section to the next folds, or its columns slip."""

from __future__ import annotations

from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Mends:
    """Sections after which something is done, by number."""

    limbs: frozenset[int] = frozenset()
    """Limbs that lie are cut off, as `limbs_cut_off`."""
    filled: frozenset[int] = frozenset()
    """Levels are put in even where loops go on one to one."""

    def more(self, folded: AbstractSet[int], slipped: AbstractSet[int], limbs: AbstractSet[int]) -> Mends:
        """Return what to do next; the same where nothing is left to be done.

        Parameters
        ----------
        folded, slipped : sets of int
            Sections after which the skin folds, or its columns slip.
        limbs : set of int
            Sections after which limbs could be cut off. A skin that needs no cut has none: a tip that draws
            back along a bent body leaves as slender a piece behind, and no edge.
        """
        cut = ((folded | slipped) & limbs) - self.limbs
        if cut:
            return replace(self, limbs=self.limbs | cut)
        return replace(self, filled=self.filled | folded)


STRAIGHT = Mends()
"""Nothing is done anywhere."""
