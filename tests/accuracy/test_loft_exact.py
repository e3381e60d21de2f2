"""The loft on exact sections of bodies with exact answers: every bound is a promise of the project."""

import numpy as np
import pytest

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.testing import phantoms
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.reconstructors.loft import LoftReconstructor

HEIGHT = "height"


def measured(stack, **options):
    found = SurfaceGauss().integrate(LoftReconstructor(**options).reconstruct(stack))
    return np.array([found.volume, found.area])


def errors(phantom, *, sections=11, placing="mid", **options):
    """Relative errors of V and S in percent."""
    if options.pop(HEIGHT, False):
        options["height"] = phantom.height
    stack = phantom.contour_stack(sections=sections, placing=placing)
    return abs(measured(stack, **options) / [phantom.volume, phantom.area] - 1) * 100


BODIES = {
    "ellipsoid": ({}, {}, 0.1, 0.1),
    "ellipsoid in pose 1": ({"rotation": 1}, {}, 0.1, 0.1),
    "ellipsoid in pose 2": ({"rotation": 2, "offset": (31.0, -250.0, 1200.0)}, {}, 0.1, 0.1),
    "slender ellipsoid in pose 3": ({"a": 40, "b": 16, "c": 12, "rotation": 3}, {}, 0.1, 0.1),
    "potato 0": ({"seed": 0}, {}, 0.1, 0.1),
    "potato 1": ({"seed": 1}, {}, 0.1, 0.1),
    "potato 2 in pose 6": ({"seed": 2, "rotation": 6}, {}, 0.1, 0.1),
    "apple": ({}, {}, 0.1, 0.1),
    "superellipsoid p2 n2.5": ({"p": 2, "n": 2.5}, {}, 0.1, 0.1),
    "superellipsoid p2 n4": ({"p": 2, "n": 4}, {}, 0.1, 0.1),
    "superellipsoid p2.5 n2": ({"p": 2.5, "n": 2}, {HEIGHT: True}, 0.1, 0.1),
    "superellipsoid p3 n2.5": ({"p": 3, "n": 2.5}, {HEIGHT: True}, 0.1, 0.1),
    "superellipsoid p3 n4": ({"p": 3, "n": 4}, {HEIGHT: True}, 0.1, 0.1),
    "superellipsoid p4 n2": ({"p": 4, "n": 2}, {HEIGHT: True}, 0.6, 0.3),
    "superellipsoid p4 n4": ({"p": 4, "n": 4}, {HEIGHT: True}, 0.6, 0.3),
    "double-cone": ({}, {"ends": "point", HEIGHT: True}, 0.2, 0.2),
    "double-cone by areas alone": ({}, {}, 0.2, 0.2),
    "cone": ({}, {"ends": "flat,point", HEIGHT: True}, 0.2, 0.2),
    "banana": ({}, {HEIGHT: True}, 0.2, 0.3),
    "box": ({}, {"placing": "faces", "ends": "face"}, 1e-10, 1e-10),
    "prism": ({}, {"placing": "faces", "ends": "face"}, 1e-10, 1e-10),
    "cylinder": ({}, {"placing": "faces", "ends": "face"}, 0.1, 0.2),
    "frustum": ({}, {"placing": "faces", "ends": "face"}, 0.1, 0.2),
    "twisted-bar": ({}, {"placing": "faces", "ends": "face"}, 0.1, 0.2),
    "meat": ({}, {"placing": "faces", "ends": "face,round", HEIGHT: True}, 0.1, 0.2),
}


@pytest.mark.parametrize("case", BODIES)
def test_eleven_sections_at_mid_thickness_or_with_faces(case):
    parameters, options, volume_bound, area_bound = BODIES[case]
    volume, area = errors(phantoms.make(_name(case), **parameters), **options)
    assert volume <= volume_bound
    assert area <= area_bound


def _name(case):
    return max((name for name in phantoms.SOLID if name in case), key=len)


def test_potatoes_in_any_pose_are_limited_by_where_they_end():
    # Without end data the pole comes from three areas; on a body whose pole sits on a bump that is wrong
    # by some tenths of a millimetre. 60 seeds: 0.024 % rms, now and then a little above 0.1 %.
    found = np.array([errors(phantoms.make("potato", seed=k, rotation=k + 4)) for k in range(20)])
    assert (found <= 0.1).mean() >= 0.95
    assert found.max() < 0.2
    told = [
        errors(potato, ends=f"round:{z[0] - low},round:{high - z[-1]}")
        for potato in (phantoms.make("potato", seed=k, rotation=k + 4) for k in range(20))
        for z, (low, high) in [(potato.contour_stack().positions, potato.extent())]
    ]
    assert np.max(told) < 0.03


@pytest.mark.parametrize("name", ["two-lobed", "dumbbell"])
@pytest.mark.parametrize("sections", [15, 25, 40, 60])
def test_a_waist_adds_no_false_area_however_many_sections(name, sections):
    volume, area = errors(phantoms.make(name), sections=sections)
    assert volume <= 0.2
    assert area <= 0.4


@pytest.mark.parametrize("points", [9, 17, 33, 65])
def test_volume_and_area_converge_with_points(points):
    volume, area = errors(phantoms.make("ellipsoid", a=30, b=20, c=25), sections=41, points=points)
    bound = 100 * (6.0 / points) ** 4
    assert volume < bound
    assert area < bound


def changed(stack, change):
    sections = tuple(Section(s.z, tuple(change(loop) for loop in s.loops), s.name) for s in stack.sections)
    return ContourStack(sections)


def started_elsewhere(loop):
    k = len(loop.points) // 3 + 1
    return Loop(np.roll(loop.points, -k, axis=0), np.sort((loop.corners - k) % len(loop.points)))


def reversed_loop(loop):
    return Loop(loop.points[::-1].copy(), np.sort(len(loop.points) - 1 - loop.corners))


def mirrored(loop):
    return Loop(loop.points * [-1.0, 1.0], loop.corners)


def turned(loop):
    a = 0.7
    return Loop(
        loop.points @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]) + [7.0, -90.0], loop.corners
    )


@pytest.mark.parametrize("name", phantoms.SOLID)
@pytest.mark.parametrize(
    ("change", "bound"), [(started_elsewhere, 1e-9), (reversed_loop, 1e-9), (mirrored, 1e-5), (turned, 1e-4)]
)
def test_what_does_not_change_the_body_does_not_change_the_figures(name, change, bound):
    plane = name in {"box", "prism", "cylinder", "frustum", "twisted-bar"}
    options = {"ends": "face"} if plane else {"ends": "flat:3,point"} if name == "cone" else {}
    stack = phantoms.make(name, offset=(11.0, -3.0, 40.0)).contour_stack(placing="faces" if plane else "mid")
    np.testing.assert_allclose(
        measured(changed(stack, change), **options), measured(stack, **options), rtol=bound
    )


@pytest.mark.parametrize("scale", [0.001, 0.5, 40.0])
def test_scaling(scale):
    stack = phantoms.make("potato", seed=4).contour_stack()
    big = ContourStack(
        tuple(
            Section(scale * s.z, tuple(Loop(scale * p.points) for p in s.loops), s.name)
            for s in stack.sections
        )
    )
    np.testing.assert_allclose(measured(big), measured(stack) * [scale**3, scale**2], rtol=1e-9)


def test_turning_the_stack_over_changes_nothing():
    stack = phantoms.make("meat").contour_stack()
    over = ContourStack(
        tuple(
            Section(-s.z, tuple(mirrored(loop) for loop in s.loops), s.name) for s in reversed(stack.sections)
        )
    )
    np.testing.assert_allclose(measured(over), measured(stack), rtol=1e-5)


def test_a_guessed_end_tells_what_it_may_cost_and_the_truth_lies_within():
    for name, parameters in (("ellipsoid", {}), ("superellipsoid", {"p": 2.5}), ("potato", {"seed": 3})):
        phantom = phantoms.make(name, **parameters)
        solid = LoftReconstructor().reconstruct(phantom.contour_stack())
        assert [n.code for n in solid.notices].count("end-guessed") == 2
        effect = sum(end.volume_effect for end in solid.ends)
        found = SurfaceGauss().integrate(solid)
        assert 0 < effect < 0.05 * phantom.volume
        assert abs(found.volume - phantom.volume) < effect


def test_a_cut_body_says_how_much_its_ends_may_cost():
    phantom = phantoms.make("ellipsoid")
    solid = LoftReconstructor().reconstruct(phantom.contour_stack(placing=[-18.0, -9.0, 0.0, 9.0, 18.0]))
    flat = SurfaceGauss().integrate(
        LoftReconstructor(ends="face").reconstruct(
            phantom.contour_stack(placing=[-18.0, -9.0, 0.0, 9.0, 18.0])
        )
    )
    whole = SurfaceGauss().integrate(solid)
    half = 0.5 * (whole.volume - flat.volume)
    assert sum(end.volume_effect for end in solid.ends) == pytest.approx(half, rel=0.02)
    assert "give --height or --ends" in solid.notices[-1].message


def test_two_sections_make_a_solid():
    found = measured(phantoms.make("box").contour_stack(sections=2, placing="faces"), ends="face")
    box = phantoms.make("box")
    np.testing.assert_allclose(found, [box.volume, box.area], rtol=1e-12)


def test_a_square_bar_turned_by_half_a_side_per_section_is_told():
    square = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * 10
    a = np.pi / 4
    turn = np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
    stack = ContourStack(
        tuple(
            Section(5.0 * k, (Loop(square @ np.linalg.matrix_power(turn, k), np.arange(4)),), f"s{k}")
            for k in range(3)
        )
    )
    solid = LoftReconstructor(ends="face").reconstruct(stack)
    assert [n.code for n in solid.notices] == ["seam-ambiguous", "seam-ambiguous"]


def both(stack, phantom, **options):
    """Errors in percent, signed, of the loft and of the flat-ended loft on the same sections."""
    exact = [phantom.volume, phantom.area]
    return [(measured(stack, **o) / exact - 1) * 100 for o in (options, {"ends": "face"})]


@pytest.mark.prove
def test_every_body_with_the_flat_ended_loft_beside(proof):
    rows = []
    for case, (parameters, options, volume_bound, area_bound) in BODIES.items():
        phantom = phantoms.make(_name(case), **parameters)
        stack = phantom.contour_stack(placing=options.get("placing", "mid"))
        said = {"height": phantom.height} if HEIGHT in options else {}
        said |= {key: options[key] for key in options if key == "ends"}
        loft, flat = both(stack, phantom, **said)
        rows.append(
            (case, *(f"{x:+.4f}" for x in loft), volume_bound, area_bound, *(f"{x:+.2f}" for x in flat))
        )
        assert abs(loft[0]) <= volume_bound
        assert abs(loft[1]) <= area_bound
    for name in ("two-lobed", "dumbbell"):
        for sections in (15, 25, 40, 60):
            phantom = phantoms.make(name)
            loft, flat = both(phantom.contour_stack(sections=sections), phantom)
            figures = (*(f"{x:+.4f}" for x in loft), 0.2, 0.4, *(f"{x:+.2f}" for x in flat))
            rows.append((f"{name}, {sections} sections", *figures))
            assert abs(loft[0]) <= 0.2
            assert abs(loft[1]) <= 0.4
    proof(
        "loft-exact",
        "The loft on exact contours, 11 sections and 33 points unless said",
        ("body", "V error %", "S error %", "V bound", "S bound", "flat ends: V %", "flat ends: S %"),
        rows,
    )


@pytest.mark.prove
def test_many_ellipsoids_and_potatoes_in_any_pose(proof):
    rows = []
    for name, low, shapes in (
        ("ellipsoid", 100, [{"a": 30, "b": 30 - 0.15 * k, "c": 30 - 0.2 * k} for k in range(100)]),
        ("potato", 300, [{"seed": k} for k in range(200)]),
        ("superellipsoid", 700, [{"p": 2, "n": 2 + 0.04 * k} for k in range(50)]),
    ):
        turned = name != "superellipsoid"
        found = np.array(
            [
                errors(phantoms.make(name, rotation=low + k if turned else None, **shape))
                for k, shape in enumerate(shapes)
            ]
        )
        share = (found <= 0.1).mean(axis=0) * 100
        rms, worst = np.sqrt((found**2).mean(axis=0)), found.max(axis=0)
        cells = [f"{x:.3f}" for pair in zip(rms, worst, strict=True) for x in pair]
        rows.append((name, len(shapes), *cells, f"{share[0]:.1f}", f"{share[1]:.1f}"))
        if name == "potato":
            assert (share >= 95).all()
            assert (worst < 0.3).all()
        else:
            assert (worst <= 0.1).all()
    proof(
        "loft-exact-many",
        "Seeded bodies in seeded poses, 11 exact sections at mid-thickness, no end data",
        (
            "body",
            "count",
            "V rms %",
            "V worst %",
            "S rms %",
            "S worst %",
            "V ≤ 0.1 %: share",
            "S ≤ 0.1 %: share",
        ),
        rows,
    )
