"""Shape interpolation on exact sections of bodies with exact answers."""

import numpy as np
import pytest

from stackloft.geometry.closed_mesh import unmatched_edges
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.testing import phantoms
from stackloft_plugins.integrators.polyhedral import Polyhedral
from stackloft_plugins.reconstructors.shape_interpolation import ShapeInterpolation

SMOOTH = {
    "ellipsoid": ({}, {}),
    "ellipsoid in pose 1": ({"rotation": 1}, {}),
    "ellipsoid in pose 2": ({"rotation": 2, "offset": (31.0, -250.0, 1200.0)}, {}),
    "slender ellipsoid in pose 3": ({"a": 40, "b": 16, "c": 12, "rotation": 3}, {}),
    "potato 0": ({"seed": 0}, {}),
    "potato 1": ({"seed": 1}, {}),
    "potato 2 in pose 6": ({"seed": 2, "rotation": 6}, {}),
    "apple": ({}, {}),
    "superellipsoid p2 n2.5": ({"p": 2, "n": 2.5}, {}),
    "superellipsoid p2 n4": ({"p": 2, "n": 4}, {}),
    "superellipsoid p3 n2.5": ({"p": 3, "n": 2.5}, {"height": True}),
    "superellipsoid p4 n4": ({"p": 4, "n": 4}, {"height": True}),
    "two-lobed": ({}, {}),
    "dumbbell": ({}, {}),
    "banana": ({}, {"height": True}),
}
OTHERS = {
    "double-cone": ({}, {"ends": "point", "height": True}),
    "cone": ({}, {"ends": "flat,point", "height": True}),
    "box": ({}, {"placing": "faces", "ends": "face"}),
    "prism": ({}, {"placing": "faces", "ends": "face"}),
    "cylinder": ({}, {"placing": "faces", "ends": "face"}),
    "frustum": ({}, {"placing": "faces", "ends": "face"}),
    "twisted-bar": ({}, {"placing": "faces", "ends": "face"}),
    "meat": ({}, {"placing": "faces", "ends": "face,round", "height": True}),
}
QUICK = ("ellipsoid in pose 1", "slender ellipsoid in pose 3", "potato 1", "apple", "dumbbell")


def measured(stack, **options):
    found = Polyhedral().integrate(ShapeInterpolation(**options).reconstruct(stack))
    return np.array([found.volume, found.area])


def errors(case, sections=21, **more):
    """Signed errors of V and S in percent."""
    parameters, options = (SMOOTH | OTHERS)[case]
    options = dict(options)
    phantom = phantoms.make(max((x for x in phantoms.NAMES if x in case), key=len), **parameters)
    if options.pop("height", False):
        options["height"] = phantom.height
    stack = phantom.contour_stack(sections=sections, placing=options.pop("placing", "mid"))
    return (measured(stack, **options, **more) / [phantom.volume, phantom.area] - 1) * 100


@pytest.mark.parametrize("case", QUICK)
def test_smooth_bodies_at_21_sections(case):
    volume, area = np.abs(errors(case, grid=64))
    assert volume <= 0.3
    assert area <= 0.3


@pytest.mark.parametrize("case", ["box", "cone", "twisted-bar", "meat"])
def test_faces_tips_and_edges(case):
    volume, area = np.abs(errors(case, grid=64))
    assert volume <= 0.3
    assert area <= 1.2


@pytest.mark.prove
def test_every_body_at_21_and_11_sections(proof):
    rows = []
    for case in SMOOTH | OTHERS:
        found = [errors(case, sections) for sections in (21, 11)]
        rows.append((case, *(f"{x:+.3f}" for pair in found for x in pair)))
        if case in SMOOTH:
            assert abs(found[0][0]) <= 1.5
            assert abs(found[0][1]) <= 2.0
    header = ("body", "V % at 21", "S % at 21", "V % at 11", "S % at 11")
    proof("shape-interpolation", "Shape interpolation on exact sections, 96 grid steps", header, rows)


def test_figures_converge_with_the_grid():
    coarse, fine = (np.abs(errors("ellipsoid in pose 1", grid=grid)) for grid in (24, 96))
    assert (fine < 0.15 * coarse).all()


def ring(inner=0.0, m=7):
    t = 2 * np.pi * np.arange(120) / 120
    circle = np.column_stack([np.cos(t), np.sin(t)])
    loops = [Loop(10 * circle)] + ([Loop(inner * circle[::-1], hole=True)] if inner else [])
    return ContourStack(tuple(Section(3.0 * k, tuple(loops), f"s{k}") for k in range(m)))


def test_holes_are_carried_along():
    volume, area = measured(ring(4.0), ends="face")
    assert volume == pytest.approx(np.pi * 84 * 18, rel=2e-3)
    assert area == pytest.approx(2 * np.pi * 84 + 2 * np.pi * 14 * 18, rel=2e-3)


def test_a_flat_end_lies_where_it_is_said_to():
    volume, area = measured(ring(), ends="flat:1.5mm")
    assert volume == pytest.approx(np.pi * 100 * 21, rel=2e-3)
    assert area == pytest.approx(2 * np.pi * 100 + 2 * np.pi * 10 * 21, rel=2e-3)


def test_the_affine_carries_the_body():
    stack = phantoms.make("potato", seed=4).contour_stack(sections=9)
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = np.diag([-1.0, 1.0, 2.0]), (5.0, 6.0, 7.0)
    moved = ContourStack(stack.sections, affine=affine)
    assert measured(moved, grid=32)[0] == pytest.approx(2 * measured(stack, grid=32)[0], rel=1e-9)


def test_a_guessed_end_is_told_and_widens_what_may_be_wrong():
    phantom = phantoms.make("ellipsoid")
    mesh = ShapeInterpolation(grid=32).reconstruct(phantom.contour_stack(sections=7))
    assert [x.code for x in mesh.notices] == ["end-guessed", "end-guessed"]
    assert mesh.volume_bias.high > 1.0
    told = ShapeInterpolation(grid=32, height=phantom.height).reconstruct(phantom.contour_stack(sections=7))
    assert told.notices == ()
    assert told.volume_bias is None
    assert unmatched_edges(told.faces) == 0


@pytest.mark.parametrize("sections", [2, 3, 4])
def test_few_sections_make_a_closed_body(sections):
    mesh = ShapeInterpolation(grid=24).reconstruct(
        phantoms.make("ellipsoid").contour_stack(sections=sections)
    )
    assert unmatched_edges(mesh.faces) == 0
    assert Polyhedral().integrate(mesh).volume > 0


def test_no_section_and_empty_ones_are_refused():
    with pytest.raises(InputError, match="at least 2 sections"):
        ShapeInterpolation().reconstruct(ContourStack(ring().sections[:1]))
    empty = Section(50.0, (), "s_empty")
    with pytest.raises(InputError, match="s_empty: a section without the body"):
        ShapeInterpolation().reconstruct(ContourStack((*ring().sections, empty)))
