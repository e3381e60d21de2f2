"""Order, start points, mirrors and a turn over leave a body the same: so they leave the loft's figures.

Bodies of every topology; asymmetric ones, which one pose tells from the other, and symmetric ones, of whose
equally good cuts one must be taken.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.testing import phantoms
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.reconstructors.loft import LoftReconstructor

SAME, MIRRORED = 1e-9, 1e-5
POSES = {label: phantom for kind in phantoms.TOPOLOGY for label, phantom in kind.phantoms()}
QUICK = (
    "torus upright",
    "tube lying",
    "dumbbell lying",
    "y-branch leaning",
    "horseshoe askew",
    "ring-branch flat",
    "two-bodies in pose 4",
)


def reordered(seed):
    def change(stack):
        rng = np.random.default_rng(seed)

        def rolled(loop):
            by = int(rng.integers(len(loop.points)))
            corners = np.sort((loop.corners + by) % len(loop.points))
            return Loop(np.roll(loop.points, by, axis=0), corners, loop.hole)

        sections = []
        for section in stack.sections:
            loops = [rolled(loop) for loop in section.loops]
            sections.append(
                Section(section.z, tuple(loops[k] for k in rng.permutation(len(loops))), section.name)
            )
        return ContourStack(tuple(sections))

    return change


def scaled(x, y):
    def change(stack):
        return ContourStack(
            tuple(
                replace(s, loops=tuple(replace(loop, points=loop.points * [x, y]) for loop in s.loops))
                for s in stack.sections
            )
        )

    return change


def turned_over(stack):
    return ContourStack(tuple(replace(s, z=-s.z) for s in stack.sections[::-1]))


CHANGES = {
    "order, starts": (reordered(1), SAME),
    "mirrored in x": (scaled(-1.0, 1.0), MIRRORED),
    "mirrored in y": (scaled(1.0, -1.0), MIRRORED),
    "turned over": (turned_over, MIRRORED),
}


def stack_of(phantom, sections):
    placing = "faces" if any(phantom.plane_ends) else "mid"
    return phantom.contour_stack(sections, placing, points=200)


def figures(stack, kinds):
    found = SurfaceGauss().integrate(LoftReconstructor(ends=",".join(kinds)).reconstruct(stack))
    return np.array([found.volume, found.area])


def shifts(phantom, sections, names):
    """Return by how much each change moves volume and area, relative."""
    stack, kinds = stack_of(phantom, sections), phantom.end_kinds
    base = figures(stack, kinds)
    return {
        name: figures(CHANGES[name][0](stack), kinds[::-1] if name == "turned over" else kinds) / base - 1.0
        for name in names
    }


@pytest.mark.parametrize("label", QUICK)
def test_the_same_body_has_the_same_figures(label):
    for name, shift in shifts(POSES[label], 11, CHANGES).items():
        assert np.abs(shift).max() <= CHANGES[name][1], name


@pytest.mark.prove
def test_every_body_in_every_pose(proof):
    found = {label: shifts(phantom, 21, CHANGES) for label, phantom in POSES.items()}
    proof(
        "loft-same-body",
        "The loft of the same body given in other ways: relative change of V and S, the larger; 21 sections",
        ("body", *CHANGES),
        [(label, *(f"{np.abs(own[name]).max():.0e}" for name in CHANGES)) for label, own in found.items()],
    )
    for label, own in found.items():
        for name, (_, bound) in CHANGES.items():
            assert np.abs(own[name]).max() <= bound, (label, name)


def test_a_mirrored_solid_is_the_solid_mirrored():
    """Shells, joints and their edges lie where the mirrored sections are, and close there."""
    phantom = POSES["y-branch leaning"]
    stack = stack_of(phantom, 15)
    one, other = (LoftReconstructor().reconstruct(s) for s in (stack, scaled(-1.0, 1.0)(stack)))
    for solid, sign in ((one, 1.0), (other, -1.0)):
        mesh = solid.tessellate(0.3)
        edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
        forward = {tuple(edge) for edge in edges.tolist()}
        assert len(forward) == len(edges)
        assert {(b, a) for a, b in forward} == forward
        points = np.concatenate([loop.points for section in stack.sections for loop in section.loops])
        low, high = points[:, 0].min(), points[:, 0].max()
        on_x = np.sort(sign * mesh.vertices[[mesh.vertices[:, 0].argmin(), mesh.vertices[:, 0].argmax()], 0])
        assert on_x == pytest.approx([low, high], abs=0.05 * (high - low))
