"""Traced boundaries lie where the body's boundary is, to a hundredth of a pixel."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from stackloft.model.contour_stack import Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.notices import Notice
from stackloft.model.segmentation import SectionField
from stackloft.sectioning.limbs import with_limbs
from stackloft.sectioning.marching_squares import closed_lines
from stackloft.sectioning.tracing import TraceRules, trace_field
from stackloft.testing.phantoms.coverage import coverage

SIZE = (160, 170)
CENTRE = np.array([83.37, 78.81])


def ellipse(a, b, degrees=0.0, centre=CENTRE, count=4000):
    t = 2 * np.pi * np.arange(count) / count
    turn = np.radians(degrees)
    axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return np.column_stack([a * np.cos(t), b * np.sin(t)]) @ axes + centre


def square(half, degrees, centre=CENTRE):
    turn = np.radians(degrees)
    axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return half * np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]]) @ axes + centre


def grey(*polygons, blur=0.0):
    """Body 60, background 230, as an 8-bit camera without noise would see it; centre of pixel 0 at 0."""
    levels = 230 - 170 * coverage([polygon + 0.5 for polygon in polygons], SIZE)
    return np.rint(gaussian_filter(levels, blur) if blur else levels)


def traced(levels, name="a.png", **rules):
    field = SectionField(-levels, -145.0)
    return trace_field(field, (1.0, 1.0), levels.shape, name, TraceRules(**rules))


def outline(levels):
    (loop,) = traced(levels).loops
    return loop


@pytest.mark.parametrize("radius", [20, 40, 70])
def test_discs(radius):
    points = outline(grey(ellipse(radius, radius))).points
    miss = np.hypot(*(points - CENTRE).T) - radius
    assert abs(miss.mean()) < 0.003
    assert miss.std() < 0.01


@pytest.mark.parametrize("degrees", [0, 7, 26.57, 45, 71])
def test_ellipses_whatever_their_turn(degrees):
    area = outline(grey(ellipse(70, 40, degrees))).signed_area
    assert area == pytest.approx(np.pi * 70 * 40, rel=1.5e-4)


@pytest.mark.parametrize("blur", [0.0, 0.6, 1.2])
@pytest.mark.parametrize("degrees", [0, 3, 20, 45, 63.43])
def test_straight_sides(degrees, blur):
    """Interpolating the pixels themselves would err by 0.09 px along a whole side at 0°."""
    points = outline(grey(square(50, degrees), blur=blur)).points - CENTRE
    turn = np.radians(degrees)
    across = np.abs(points @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]))
    side = across.min(axis=1) < 44
    miss = across.max(axis=1)[side] - 50
    assert np.abs(miss).max() < 0.025
    assert abs(miss.mean()) < 0.012


def test_mirrored_and_turned_pictures_give_the_same_area():
    levels = grey(ellipse(61, 33, 17))
    area = outline(levels).signed_area
    for other in (levels[::-1], levels[:, ::-1], np.rot90(levels)):
        assert outline(other).signed_area == pytest.approx(area, rel=1e-12)


def test_millimetres_offset_and_direction():
    levels = grey(ellipse(30, 20))
    field = SectionField(-levels[40:130, 30:140], -145.0, offset=(40, 30))
    (loop,) = trace_field(field, (0.5, 0.25), SIZE, "a").loops
    assert loop.signed_area == pytest.approx(np.pi * 30 * 20 * 0.125, rel=1e-3)
    middle = (loop.points.min(axis=0) + loop.points.max(axis=0)) / 2
    assert middle == pytest.approx(CENTRE * [0.25, 0.5], abs=0.01)


def test_a_varying_level():
    slope = np.linspace(0, 60, SIZE[1])[None, :]
    levels = grey(ellipse(60, 40)) - slope
    field = SectionField(-levels, 0.0, local_levels=np.broadcast_to(slope - 145, SIZE))
    (loop,) = trace_field(field, (1.0, 1.0), SIZE, "a").loops
    assert loop.signed_area == pytest.approx(np.pi * 60 * 40, rel=3e-4)


def test_a_hole_that_shows_the_background_is_a_hole():
    result = traced(grey(ellipse(60, 50), ellipse(15, 12)[::-1]))
    outer, hole = result.loops
    assert (outer.hole, hole.hole) == (False, True)
    assert hole.signed_area == pytest.approx(-np.pi * 15 * 12, rel=2e-3)
    assert not result.notices


def test_fat_is_no_hole():
    levels = grey(ellipse(60, 50))
    levels[60:90, 70:100] = 155
    result = traced(levels)
    assert len(result.loops) == 1
    assert not result.notices


def test_glare_is_filled_and_said():
    result = traced(grey(ellipse(60, 50), ellipse(2.6, 2)[::-1]), name="cut_3.jpg")
    assert len(result.loops) == 1
    assert result.notices[0].code == "hole-filled"
    assert "cut_3.jpg" in result.notices[0].message


def test_what_may_be_a_holes_end_is_left_to_the_slices_beside_it():
    result = traced(grey(ellipse(60, 50), ellipse(5, 4)[::-1]), name="cut_3.jpg")
    assert len(result.loops) == 1
    assert not result.notices
    ((hole, notice),) = result.perhaps
    assert hole.hole
    assert notice.code == "hole-filled"
    assert "cut_3.jpg" in notice.message


def test_a_holes_end_is_kept_beside_a_hole_and_filled_elsewhere():
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    outline, bore, end = Loop(30 * ring), Loop(8 * ring[::-1], hole=True), Loop(2 * ring[::-1], hole=True)
    sections = [
        Section(0.0, (outline, bore), "a"),
        Section(1.0, (outline,), "b"),
        Section(2.0, (outline,), "c"),
    ]
    told = Notice("hole-filled", "c: filled")
    kept, left_out = with_limbs(sections, [[], [(end, told)], []])
    assert kept[1].loops == (outline, end)
    assert left_out == []
    kept, left_out = with_limbs(sections, [[], [], [(end, told)]])
    assert kept[2].loops == (outline,)
    assert left_out == [told]


def test_crumbs_go_unsaid_a_second_object_is_said_a_branch_is_kept():
    body = ellipse(40, 40, centre=np.array([60.0, 80.0]))
    for radius, loops, codes in ((3, 1, []), (12, 1, ["second-object"]), (25, 2, [])):
        result = traced(grey(body, ellipse(radius, radius, centre=np.array([135.0, 80.0]))))
        assert len(result.loops) == loops
        told = [notice for _, notice in result.perhaps]
        assert [notice.code for notice in (*result.notices, *told)] == codes


@pytest.mark.parametrize(
    ("centre", "side"), [((83, 10), "top"), ((83, 150), "bottom"), ((10, 80), "left"), ((160, 80), "right")]
)
def test_border_contact_names_file_and_side(centre, side):
    result = traced(grey(ellipse(30, 30, centre=np.array(centre, dtype=float))), name="b.png")
    (notice,) = result.notices
    assert notice.code == "border-contact"
    assert "b.png" in notice.message
    assert f"{side} edge" in notice.message
    assert len(result.loops) == 1


def test_a_crop_inside_the_picture_is_no_border():
    levels = grey(ellipse(30, 20))[50:110, 45:120]
    assert not trace_field(SectionField(-levels, -145.0, offset=(50, 45)), (1, 1), SIZE, "a").notices


@pytest.mark.parametrize("levels", [np.full(SIZE, 230.0), grey(ellipse(1.2, 1.2))])
def test_no_body(levels):
    with pytest.raises(InputError, match=r"a\.png: no body found"):
        traced(levels)


def test_lines_close_on_any_field():
    rng = np.random.default_rng(5)
    for _ in range(30):
        field = np.pad(rng.normal(size=(14, 17)), 1, constant_values=-1.0)
        inside = field > 0
        lines = closed_lines(inside, field)
        along_rows = np.count_nonzero(inside[:, 1:] != inside[:, :-1])
        along_columns = np.count_nonzero(inside[1:] != inside[:-1])
        assert sum(len(line.row) for line in lines) == along_rows + along_columns


def test_levels_that_equal_the_threshold_break_nothing():
    levels = np.full((40, 40), 230.0)
    levels[10:30, 10:30] = 60.0
    levels[10, 12:20] = levels[20:25, 30] = 145.0
    loop = outline(levels)
    steps = np.linalg.norm(np.roll(loop.points, -1, axis=0) - loop.points, axis=1)
    assert steps.min() > 0
    assert loop.signed_area == pytest.approx(400, abs=8)
