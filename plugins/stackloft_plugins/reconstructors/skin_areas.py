"""Whether skins have no more area than there is to go over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
        Naming the two rows between which there is the most false area.
    """
    slips = slipped_rows([_between_rows(one) for one in skinned])
    if slips:
        k, row = slips[0]
        rows = skinned[k].tube.rows
        raise fold_error(rows[row].name, rows[row + 1].name)


def slipped_sections(skinned: list[Skinned]) -> set[int]:
    """Return the sections after which, before the next one, columns slipped."""
    found = set()
    for k, row in slipped_rows([_between_rows(one) for one in skinned]):
        low, high = skinned[k].tube.rows[row : row + 2]
        if low.section is not None and high.section is not None:
            found.add(low.section)
    return found


def slipped_rows(skins: Sequence[FloatArray]) -> list[tuple[int, int]]:
    """Return (skin, row) where columns slipped between a row and the next, most false area first.

    Parameters
    ----------
    skins : sequence of (n - 1, N, 4, 4, 3) arrays
        The patches between the n rows of each, mm.
    """
    found = {k: areas_beyond(patches) for k, patches in enumerate(skins) if len(patches)}
    whole = sum(area for _, area in found.values())
    slips = [
        (float(beyond[row]), k, int(row))
        for k, (beyond, _) in found.items()
        for row in np.flatnonzero(beyond > SLIPPED * whole)
    ]
    return [(k, row) for _, k, row in sorted(slips, key=lambda slip: -slip[0])]


def _between_rows(one: Skinned) -> FloatArray:
    first = first_patch(one)
    return one.patches[first : first + len(one.tube.rows) - 1]


def first_patch(one: Skinned) -> int:
    """Return the number of the row of patches that leaves the tube's first row: 1 after a pole."""
    z = one.tube.rows[0].z
    return int(one.patches[0, 0, 0, 0, 2] < z - 1e-12 * abs(z))
