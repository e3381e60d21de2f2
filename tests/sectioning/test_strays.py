"""What one photograph alone shows, at its edge or as a hole, is no part of the body and is told."""

import numpy as np
import pytest

from stackloft.model.contour_stack import Loop, Section
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.sectioning.contour_sink import trace_stack
from stackloft.sectioning.strays import without_strays
from stackloft_plugins.segmenters.histogram import HistogramSegmenter

T = 2 * np.pi * np.arange(60) / 60


def disc(x, radius, *, hole=False):
    turn = -1 if hole else 1
    return Loop(np.column_stack([x + radius * np.cos(turn * T), radius * np.sin(turn * T)]), hole=hole)


def stack(*loops):
    return [Section(float(k), tuple(own), f"cut_{k}.jpg") for k, own in enumerate(loops)]


def test_a_reflection_at_the_edge_is_left_out_even_when_it_is_larger_than_the_section():
    body, lamp = disc(0.0, 20.0), disc(80.0, 30.0)
    sections = stack([body], [lamp, body], [body])
    found, (notice,) = without_strays(sections, [[False], [True, False], [False]])
    assert [len(section.loops) for section in found] == [1, 1, 1]
    assert notice.code == "edge-object"
    assert notice.message.startswith("cut_1.jpg: left out what lies at the picture's edge (225.0 %")


def test_a_limb_at_the_edge_and_a_body_cut_off_stay():
    body, limb = disc(0.0, 20.0), disc(80.0, 15.0)
    sections = stack([body, limb], [body, limb], [body])
    assert without_strays(sections, [[True, True]] * 2 + [[True]]) == (sections, [])


@pytest.mark.parametrize(("radius", "left"), [(4.0, 1), (6.0, 2)])
def test_a_small_hole_in_one_section_is_glare(radius, left):
    body, hole = disc(0.0, 20.0), disc(5.0, radius, hole=True)
    found, notices = without_strays(stack([body], [body, hole], [body]), [[False]] * 3)
    assert len(found[1].loops) == left
    assert [notice.code for notice in notices] == ["hole-filled"] * (2 - left)


@pytest.mark.parametrize(("tip", "left"), [(10.0, 1), (5.5, 2)])
def test_a_lamp_is_as_large_on_the_tip_as_on_the_middle(tip, left):
    body, end, hole = disc(0.0, 20.0), disc(0.0, tip), disc(1.0, 2.8, hole=True)
    sections = stack([end, hole], [body], [body])
    found, notices = without_strays(sections, [[False, False], [False], [False]])
    assert len(found[0].loops) == left
    assert [notice.code for notice in notices] == ["hole-filled"] * (2 - left)


def test_a_bore_stays():
    sections = stack(*[[disc(0.0, 20.0), disc(5.0, 4.0, hole=True)]] * 3)
    assert without_strays(sections, [[False, False]] * 3) == (sections, [])


def test_pictures_with_crumbs_and_a_lamp_at_the_edge():
    def picture(k):
        grey = np.full((90, 120), 20, dtype=np.uint8)
        grey[30:60, 40:80] = 150
        grey[50:53, 117:] = 150  # a crumb
        if k == 2:
            grey[:40, 90:] = 250
        return grey

    names = tuple(f"{k}.png" for k in range(4))
    pictures = SliceStack(picture, names, (90, 120), np.arange(4.0), np.full((4, 2), 0.3), SectionKind.FACE)
    contours = trace_stack(HistogramSegmenter().segment(pictures))
    assert {len(section.loops) for section in contours.sections} == {1}
    assert [one.code for one in contours.notices] == ["edge-object"]
    assert contours.notices[0].message.startswith("2.png: ")
