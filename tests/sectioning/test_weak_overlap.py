"""Sections that hardly overlap are told of, and parts that come and go between two sections."""

from __future__ import annotations

import numpy as np
import pytest

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft_plugins.reconstructors.loft import LoftReconstructor

T = 2 * np.pi * np.arange(60) / 60
CIRCLE = np.column_stack([10 * np.cos(T), 10 * np.sin(T)])


def stack(*rows):
    """Return a stack; each row is the centres' x of its circles, 8 mm apart along z."""
    return ContourStack(
        tuple(
            Section(8.0 * k, tuple(Loop(CIRCLE + [x, 0.0]) for x in row), f"cut {k}")
            for k, row in enumerate(rows)
        )
    )


def codes(contours):
    return [notice.code for notice in LoftReconstructor(ends="face,face").reconstruct(contours).notices]


@pytest.mark.parametrize(("shift", "told"), [(0.0, 0), (4.0, 0), (11.0, 0), (14.0, 1)])
def test_circles_that_share_less_than_three_tenths_are_told_of(shift, told):
    """Two circles of radius 10 at 12.3 mm share 30 % of one."""
    found = codes(stack([0.0], [0.0], [shift], [shift]))
    assert found.count("weak-link") == told


def test_the_notice_names_both_sections():
    solid = LoftReconstructor(ends="face,face").reconstruct(stack([0.0], [0.0], [14.0], [14.0]))
    (notice,) = [n for n in solid.notices if n.code == "weak-link"]
    assert "cut 1 to cut 2" in notice.message


def test_a_part_that_ends_where_another_begins_is_told_of():
    found = codes(stack([0.0, 40.0], [0.0, 40.0], [0.0, 70.0], [0.0, 70.0]))
    assert found.count("part-lost") == 1


def test_a_part_that_only_ends_is_not():
    assert "part-lost" not in codes(stack([0.0, 40.0], [0.0, 40.0], [0.0], [0.0]))
