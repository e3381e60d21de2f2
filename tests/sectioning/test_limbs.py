"""Limbs' tips are kept, crumbs are not."""

import numpy as np

from stackloft.model.contour_stack import Loop, Section
from stackloft.model.notices import Notice
from stackloft.sectioning.limbs import with_limbs

T = 2 * np.pi * np.arange(40) / 40


def disc(x, radius):
    return Loop(np.column_stack([x + radius * np.cos(T), radius * np.sin(T)]))


def test_a_tip_over_a_limb_is_kept_and_carries_the_next_one():
    limb, body = disc(40.0, 8.0), disc(0.0, 20.0)
    sections = [Section(0.0, (body, limb), "a"), Section(1.0, (body,), "b"), Section(2.0, (body,), "c")]
    notice = Notice("second-object", "left out")
    perhaps = [[], [(disc(41.0, 5.0), notice)], [(disc(42.0, 3.0), notice)]]
    found, left_out = with_limbs(sections, perhaps)
    assert [len(section.loops) for section in found] == [2, 2, 2]
    assert not left_out


def test_a_crumb_beside_the_body_is_left_out_and_told():
    sections = [Section(float(k), (disc(0.0, 20.0),), str(k)) for k in range(3)]
    notice = Notice("second-object", "left out")
    found, left_out = with_limbs(sections, [[], [(disc(60.0, 6.0), notice)], []])
    assert [len(section.loops) for section in found] == [1, 1, 1]
    assert left_out == [notice]
