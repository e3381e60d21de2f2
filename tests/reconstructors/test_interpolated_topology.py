"""Shape interpolation of rings, holes, cavities, limbs and several pieces, against their exact answers."""

import numpy as np
import pytest

import stackloft
from stackloft.geometry.closed_mesh import unmatched_edges
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.testing import phantoms
from stackloft_plugins.integrators.polyhedral import Polyhedral
from stackloft_plugins.reconstructors.shape_interpolation import ShapeInterpolation

POSES = {label: phantom for case in phantoms.TOPOLOGY for label, phantom in case.phantoms()}
QUICK = [
    "torus flat",
    "torus upright",
    "hollow-sphere in pose 1",
    "y-branch leaning",
    "ring-branch upright",
    "horseshoe lying",
]


def exact(phantom, sections=21):
    """Exact sections, and how the body ends where it ends in a plane."""
    planes = any(phantom.plane_ends)
    stack = phantom.contour_stack(sections, "faces" if planes else "mid")
    return stack, {"ends": "face"} if planes else {}


def errors(phantom, mesh):
    found = Polyhedral().integrate(mesh)
    return 100 * (np.array([found.volume / phantom.volume, found.area / phantom.area]) - 1)


@pytest.mark.parametrize("label", QUICK)
def test_any_topology_from_exact_sections(label):
    stack, options = exact(POSES[label])
    mesh = ShapeInterpolation(grid=64, **options).reconstruct(stack)
    volume, area = np.abs(errors(POSES[label], mesh))
    assert volume <= 1.5
    assert area <= 2.5
    assert unmatched_edges(mesh.faces) == 0


def test_a_through_hole_stays_open_at_plane_ends_and_a_blind_one_at_its_own():
    for label, sheets in (("tube upright", 0), ("blind-hole upright", 2)):
        stack, options = exact(POSES[label], 9)
        mesh = ShapeInterpolation(grid=48, **options).reconstruct(stack)
        assert len(mesh.vertices) - len(mesh.faces) // 2 == sheets  # Euler: V − E + F, 3F = 2E
    tube = POSES["tube upright"]
    stack, _ = exact(tube, 9)
    volume, area = np.abs(errors(tube, ShapeInterpolation(grid=48, ends="face").reconstruct(stack)))
    assert volume <= 0.1
    assert area <= 0.1


def test_a_ring_closes_over_its_ridge_where_that_is():
    """Half-width² is a parabola in z: the ends of a torus are found to rounding of the grid."""
    torus = phantoms.make("torus")
    stack = torus.contour_stack(9)
    mesh = ShapeInterpolation(grid=64).reconstruct(stack)
    low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
    assert (low, high) == pytest.approx(torus.extent(), abs=0.15)


def changed(stack, change):
    return ContourStack(
        tuple(Section(s.z, tuple(change(loop) for loop in s.loops[::-1]), s.name) for s in stack.sections)
    )


def test_order_start_and_direction_of_loops_do_not_matter():
    stack, _ = exact(POSES["ring-branch leaning"], 11)
    same = changed(stack, lambda loop: Loop(np.roll(loop.points, 57, axis=0)[::-1], hole=loop.hole))
    a, b = (Polyhedral().integrate(ShapeInterpolation(grid=40).reconstruct(x)) for x in (stack, same))
    assert (b.volume, b.area) == pytest.approx((a.volume, a.area), rel=1e-6)


def test_a_mirror_image_has_the_same_figures():
    stack, _ = exact(POSES["y-branch leaning"], 11)
    mirrored = changed(stack, lambda loop: Loop(loop.points * [-1.0, 1.0], hole=loop.hole))
    a, b = (Polyhedral().integrate(ShapeInterpolation(grid=40).reconstruct(x)) for x in (stack, mirrored))
    assert (b.volume, b.area) == pytest.approx((a.volume, a.area), rel=2e-3)


def test_bodies_that_end_and_begin_between_sections():
    """Two balls, one above the other, whose sections never share a plane."""
    ball = phantoms.make("ellipsoid", a=10, b=10, c=10)
    z = [-9.0, -5.5, -2.0, 1.5, 5.0, 8.5]
    low = [Section(h, ball.section(h), f"low {h}") for h in z]
    high = [
        Section(h + 21.0, tuple(Loop(loop.points + [14.0, 1.0]) for loop in ball.section(h)), f"high {h}")
        for h in z
    ]
    mesh = ShapeInterpolation().reconstruct(ContourStack((*low, *high)))
    found = Polyhedral().integrate(mesh)
    assert found.volume == pytest.approx(2 * ball.volume, rel=0.02)
    assert unmatched_edges(mesh.faces) == 0


@pytest.mark.prove
def test_every_topology_and_pose(proof, tmp_path):
    rows = []
    for label, phantom in POSES.items():
        stack, options = exact(phantom)
        mesh = ShapeInterpolation(**options).reconstruct(stack)
        found = errors(phantom, mesh)
        assert unmatched_edges(mesh.faces) == 0, label
        assert abs(found[0]) <= 1.5, label
        assert abs(found[1]) <= 2.5, label
        seen = photographed(phantom, tmp_path / label, options)
        rows.append((label, *(f"{x:+.3f}" for x in (*found, *seen))))
        assert abs(seen[0]) <= 1.5, label
        assert abs(seen[1]) <= 2.5, label
    proof(
        "shape-interpolation-topology",
        "Shape interpolation of any topology at 21 sections, ends guessed: exact sections and 0.3 mm pixels",
        ["body", "V %", "S %", "V % photographs", "S % photographs"],
        rows,
    )


def photographed(phantom, folder, options):
    placing = "faces" if options else "mid"
    phantoms.write_photos(phantom, folder, sections=21, placing=placing, pixel_size=0.3)
    result = stackloft.measure(folder, method="shape-interpolation", **options)
    body = result.objects[0]
    return 100 * (np.array([body.volume.value / phantom.volume, body.area.value / phantom.area]) - 1)
