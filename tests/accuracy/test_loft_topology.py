"""The loft on bodies with holes, cavities, limbs and several pieces, against exact answers."""

from __future__ import annotations

import numpy as np
import pytest

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.testing import phantoms
from stackloft_plugins.integrators.polyhedral import Polyhedral
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.reconstructors.loft import LoftReconstructor

VOLUME, AREA = 0.5, 1.0
CASES = [
    pytest.param(kind, label, phantom, id=label)
    for kind in phantoms.TOPOLOGY
    for label, phantom in kind.phantoms()
]
QUICK = {
    "torus flat",
    "torus leaning",
    "tube lying",
    "tube upright",
    "hollow-sphere as made",
    "y-branch upright",
    "horseshoe lying",
    "horseshoe askew",
    "apple square to its core",
    "two-bodies in pose 4",
}


def stack_of(phantom, sections=21, points=200):
    placing = "faces" if any(phantom.plane_ends) else "mid"
    return phantom.contour_stack(sections, placing, points=points)


def errors(stack, phantom, **options):
    ends = ",".join(phantom.end_kinds)
    solid = LoftReconstructor(ends=ends, **options).reconstruct(stack)
    found = SurfaceGauss().integrate(solid)
    return 100 * (found.volume / phantom.volume - 1), 100 * (found.area / phantom.area - 1), solid


@pytest.mark.parametrize(("kind", "label", "phantom"), [c for c in CASES if c.id in QUICK])
def test_exact_sections_of_every_topology(kind, label, phantom):
    volume, area, solid = errors(stack_of(phantom), phantom)
    assert abs(volume) <= VOLUME
    assert abs(area) <= AREA
    mesh = solid.tessellate(0.3)
    edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    forward = {tuple(edge) for edge in edges.tolist()}
    assert len(forward) == len(edges)
    assert {(b, a) for a, b in forward} == forward  # closed and oriented
    assert len(np.unique(mesh.faces)) - len(forward) // 2 + len(mesh.faces) == kind.euler
    assert Polyhedral().integrate(mesh).volume == pytest.approx(phantom.volume, rel=0.02)


@pytest.mark.prove
def test_all_bodies_in_all_poses(proof):
    rows = []
    for case in CASES:
        _, label, phantom = case.values
        volume, area, solid = errors(stack_of(phantom), phantom)
        rows.append((label, volume, area, len(solid.shells), len(solid.joints)))
    proof(
        "loft-topology",
        "The loft on bodies of every topology: exact contours, 21 sections, 33 points",
        ("body", "V %", "S %", "shells", "joints"),
        [(n, f"{v:+.3f}", f"{a:+.3f}", k, j) for n, v, a, k, j in rows],
    )
    for label, volume, area, _, _ in rows:
        assert abs(volume) <= VOLUME, label
        assert abs(area) <= AREA, label


@pytest.mark.parametrize(
    "count",
    [11, 30, pytest.param(20, marks=pytest.mark.prove), pytest.param(45, marks=pytest.mark.prove), 60],
)
def test_area_does_not_depend_on_how_many_sections_pass_through_a_branch(count):
    phantom = phantoms.make("y-branch")
    _, area, _ = errors(stack_of(phantom, count), phantom)
    assert abs(area) <= AREA


def rolled(loop, by):
    corners = np.sort((loop.corners + by) % len(loop.points))
    return Loop(np.roll(loop.points, by, axis=0), corners, loop.hole)


def reordered(stack, seed):
    rng = np.random.default_rng(seed)
    sections = []
    for section in stack.sections:
        loops = [rolled(loop, int(rng.integers(len(loop.points)))) for loop in section.loops]
        sections.append(
            Section(section.z, tuple(loops[k] for k in rng.permutation(len(loops))), section.name)
        )
    return ContourStack(tuple(sections))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("label", "allowed"),
    [
        ("blind-hole leaning", 1e-9),
        ("ring-branch leaning", 1e-9),
        ("torus upright", 1e-5),  # its cuts have mirror images of equal length, and one must be taken
    ],
)
def test_loop_order_and_start_points_decide_nothing(label, allowed, seed):
    stack = stack_of(dict(kind_poses())[label], 11)
    base, other = (
        SurfaceGauss().integrate(LoftReconstructor().reconstruct(s)) for s in (stack, reordered(stack, seed))
    )
    assert other.volume == pytest.approx(base.volume, rel=allowed)
    assert other.area == pytest.approx(base.area, rel=allowed)


def test_a_mirrored_body_measures_the_same():
    phantom = phantoms.make("y-branch")
    stack = stack_of(phantom, 15)
    flipped = ContourStack(
        tuple(
            Section(
                s.z,
                tuple(Loop(loop.points * [-1.0, 1.0], loop.corners, loop.hole) for loop in s.loops),
                s.name,
            )
            for s in stack.sections
        )
    )
    base, other = (SurfaceGauss().integrate(LoftReconstructor().reconstruct(s)) for s in (stack, flipped))
    assert other.volume == pytest.approx(base.volume, rel=2e-5)
    assert other.area == pytest.approx(base.area, rel=1e-4)


@pytest.mark.parametrize("count", [41, pytest.param(120, marks=pytest.mark.prove)])
def test_levels_a_hair_apart_add_no_area(count):
    """Of a ring cut askew by many sections: columns that slipped there once made it four times as large."""
    phantom = dict(kind_poses())["torus leaning"]
    volume, area, _ = errors(stack_of(phantom, count), phantom)
    assert abs(volume) <= 0.05
    assert abs(area) <= 0.1


def kind_poses():
    return [(label, phantom) for kind in phantoms.TOPOLOGY for label, phantom in kind.phantoms()]


def test_a_skin_whose_columns_slipped_is_no_figure():
    """A lying limb appears at once between two sections: 12 % of false area were once a figure."""
    phantom = dict(kind_poses())["ring-branch flat"]
    with pytest.raises(InputError, match="section_09: the loft folds"):
        errors(stack_of(phantom, 53), phantom)
