"""Whether skins have no more area than there is to go over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from stackloft.geometry.swept_area import areas_beyond
from stackloft.model.arrays import FloatArray
from stackloft.sectioning.equal_points import EqualSections
from stackloft.sectioning.self_check import fold_error
from stackloft.sectioning.tube_ends import PlannedTube

SLIPPED = 0.002
"""Area beyond what there is to go over between two rows, as a fraction of the whole skin's, that is none:
sound skins of two to sixty sections have at most a tenth of it, from counting on a grid."""


@dataclass(frozen=True, slots=True, eq=False)
class Skinned:
    """A tube as patches."""

    tube: PlannedTube
    sections: EqualSections
    patches: FloatArray


def check_skin_areas(skinned: list[Skinned]) -> None:
    """Refuse skins with more area between two rows than there is to go over: their columns slipped.

    Raises
    ------
    InputError
    """
    skins = []
    for one in skinned:
        first, rows = first_patch(one), one.tube.rows
        skins.append((one.patches[first : first + len(rows) - 1], [row.name for row in rows]))
    refuse_slipped(skins)


def refuse_slipped(skins: Sequence[tuple[FloatArray, Sequence[str]]]) -> None:
    """Refuse skins whose columns slipped between two rows.

    Parameters
    ----------
    skins : sequence of ((n - 1, N, 4, 4, 3) array, n names)
        The patches between the rows of each, mm, and the rows' names.

    Raises
    ------
    InputError
        Naming the two rows between which there is the most false area.
    """
    found = [areas_beyond(patches) for patches, _ in skins if len(patches)]
    named = [names for patches, names in skins if len(patches)]
    whole = sum(area for _, area in found)
    worst = max(range(len(found)), key=lambda k: float(found[k][0].max()), default=None)
    if worst is None or found[worst][0].max() <= SLIPPED * whole:
        return
    row = int(found[worst][0].argmax())
    raise fold_error(named[worst][row], named[worst][row + 1])


def first_patch(one: Skinned) -> int:
    """Return the number of the row of patches that leaves the tube's first row: 1 after a pole."""
    z = one.tube.rows[0].z
    return int(one.patches[0, 0, 0, 0, 2] < z - 1e-12 * abs(z))
