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


@pytest.mark.parametrize(("turn", "told"), [(10.0, 0), (40.0, 0), (50.0, 4), (55.0, 4)])
def test_crescents_carried_far_round_are_told_of(turn, told):
    """A coil of eleven sections had 5 % too much area, without a word."""
    t = np.radians(70.0) * np.linspace(-1.0, 1.0, 80)
    half = 6.0 * np.sqrt(1.0 - (t / t[-1]) ** 2)
    sides = [np.stack([r * np.cos(t), r * np.sin(t)], axis=1) for r in (24.0 + half, 24.0 - half)]
    crescent = np.concatenate([sides[0][:-1], sides[1][:0:-1]])
    sections = []
    for k in range(5):
        a = np.radians(turn * k)
        turned = crescent @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
        sections.append(Section(8.0 * k, (Loop(turned),), f"cut {k}"))
    assert codes(ContourStack(tuple(sections))).count("part-turns") == told
