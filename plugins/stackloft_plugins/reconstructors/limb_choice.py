"""Whether limbs that lie are cut off: where the skin has less area so."""

from __future__ import annotations

from collections.abc import Set as AbstractSet

import numpy as np

from stackloft.geometry.patch_integrals import patch_areas
from stackloft.model.arrays import FloatArray
from stackloft_plugins.reconstructors.skin_areas import Skinned


def limbs_worth_cutting(
    whole: list[Skinned], cut: list[Skinned], limbs: AbstractSet[int], z: FloatArray
) -> frozenset[int]:
    """Return the sections after which cutting limbs off leaves less area than a skin drawn straight over.

    A slender piece that is there at once has walls and a root; drawn out of the root it has a skin that is
    longer than both. A tip that only draws back along its body costs more when it is cut.

    Parameters
    ----------
    whole, cut : lists of Skinned
        The body with no limb cut off, and with all of them.
    limbs : set of int
        Sections after which there are some.
    z : (m,) array
        The sections' positions, mm.
    """
    areas = [_areas_between(skinned, z) for skinned in (whole, cut)]
    chosen = []
    for k in limbs:
        around = slice(max(k - 1, 0), k + 2)  # a row's slopes come from its neighbours
        if areas[1][around].sum() < areas[0][around].sum():
            chosen.append(k)
    return frozenset(chosen)


def _areas_between(skinned: list[Skinned], z: FloatArray) -> FloatArray:
    """Return the skins' area between each section and the next, (m - 1,) mm²."""
    found = np.zeros(len(z) - 1)
    for one in skinned:
        middle = one.patches[:, 0, [0, 3], 0, 2].mean(axis=1)
        interval = np.searchsorted(z, middle) - 1
        within = (interval >= 0) & (interval < len(found))
        np.add.at(found, interval[within], patch_areas(one.patches[within], degree=4).sum(axis=1))
    return found
