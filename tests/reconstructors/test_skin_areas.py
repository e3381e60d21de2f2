"""A skin whose columns slipped is refused by the area it has beyond what there is to go over."""

from __future__ import annotations

import numpy as np
import pytest

from stackloft.geometry.loft_rows import RowEnd, closed_rows
from stackloft.geometry.skin import skin
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.sectioning.equal_points import EqualSections, equal_points
from stackloft.sectioning.tube_ends import FACE, PlannedTube, TubeEnd
from stackloft.sectioning.tube_rows import Row
from stackloft_plugins.reconstructors.loft import LoftReconstructor
from stackloft_plugins.reconstructors.skin_areas import Skinned, check_skin_areas


def skinned(slip):
    """Return a straight tube; from its third row on the columns are `slip` points farther round."""
    t = 2 * np.pi * np.arange(60) / 60
    loop = Loop(np.column_stack([30 * np.cos(t), 5 * np.sin(t)]))
    sections = tuple(Section(float(k), (loop,), f"cut {k}") for k in range(5))
    equal = equal_points(ContourStack(sections), 33)
    points = equal.points.copy()
    points[2:] = np.roll(points[2:], slip, axis=1)
    rows = tuple(Row(s.z, loop, s.name, k, hole=False) for k, s in enumerate(sections))
    end = RowEnd(0.0, pole=False)
    patches = skin(closed_rows(points, equal.corners, (end, end)))
    tube = PlannedTube(rows, (TubeEnd(FACE, outer=True), TubeEnd(FACE, outer=True)))
    return Skinned(tube, EqualSections(points, equal.corners, equal.curves, ()), patches)


def test_a_straight_skin_passes():
    check_skin_areas([skinned(0)])


def test_slipped_columns_are_refused_by_name():
    with pytest.raises(InputError, match="cut 1 to cut 2: the loft folds"):
        check_skin_areas([skinned(11)])


def test_a_single_tube_is_held_against_what_it_goes_over_too():
    """Thin crescents, each carried half round the ring: none of their parts lies on the next one's."""
    t = np.radians(110.0) * np.linspace(-1.0, 1.0, 80)
    half = 3.0 * np.sqrt(1.0 - (t / t[-1]) ** 2)
    sides = [np.stack([r * np.cos(t), r * np.sin(t)], axis=1) for r in (24.0 + half, 24.0 - half)]
    crescent = np.concatenate([sides[0][:-1], sides[1][:0:-1]])
    sections = []
    for k in range(6):
        a = np.radians(110.0 * k)
        turned = crescent @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
        sections.append(Section(4.0 * k, (Loop(turned),), f"cut {k}"))
    with pytest.raises(InputError, match=r"cut \d to (between )?cut \d"):
        LoftReconstructor().reconstruct(ContourStack(tuple(sections)))
