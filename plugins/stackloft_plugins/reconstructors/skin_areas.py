"""Whether skins have no more area than there is to go over."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stackloft.geometry.patch_integrals import solid_integrals
from stackloft.geometry.swept_area import swept_area
from stackloft.model.arrays import FloatArray
from stackloft.sectioning.equal_points import EqualSections
from stackloft.sectioning.self_check import fold_error
from stackloft.sectioning.tube_ends import PlannedTube

SLIPPED = 0.02
"""Area beyond what there is to go over between two rows, as a fraction of the whole skin's, that is none."""


@dataclass(frozen=True, slots=True, eq=False)
class Skinned:
    """A tube as patches."""

    tube: PlannedTube
    sections: EqualSections
    patches: FloatArray


def check_skin_areas(skinned: list[Skinned]) -> None:
    """Refuse skins with much more area between two rows than there is to go over: their columns slipped."""
    found = []
    for one in skinned:
        rows = one.tube.rows
        for k, (low, high) in enumerate(pairwise(rows), start=first_patch(one)):
            if k >= len(one.patches):
                break
            _, area = solid_integrals(one.patches[k : k + 1], (0.0, 0.0), np.eye(4), degree=4)
            found.append((area, swept_area(low.loop.points, high.loop.points, high.z - low.z), low, high))
    total = sum(area for area, *_ in found)
    for area, needed, low, high in found:
        if area - needed > SLIPPED * total:
            raise fold_error(low.name, high.name)


def first_patch(one: Skinned) -> int:
    """Return the number of the row of patches that leaves the tube's first row: 1 after a pole."""
    z = one.tube.rows[0].z
    return int(one.patches[0, 0, 0, 0, 2] < z - 1e-12 * abs(z))
