"""Checks of reconstructors; run them with one pytest call.

::

    @pytest.mark.parametrize("check", reconstructor_checks(ReconstructorCase(MyReconstructor)), ids=str)
    def test_my_reconstructor(check):
        check()
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from stackloft.geometry.closed_mesh import mesh_integrals, unmatched_edges
from stackloft.model.arrays import frozen_floats
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import StackloftError
from stackloft.model.tri_mesh import TriMesh
from stackloft.testing.conformance import ellipsoids
from stackloft.testing.conformance.adding import must_add_up
from stackloft.testing.conformance.check import Check, must, must_refuse, suite
from stackloft.testing.conformance.comparing import must_be_same
from stackloft.testing.conformance.moving import emptied, opened, started_elsewhere, transformed, turned_over
from stackloft.testing.conformance.option_checks import check_options, check_shape
from stackloft.testing.conformance.reconstructor_case import ReconstructorCase, mesh_of

FINENESS = (1, 2, 3)
"""Resolutions on which convergence is judged."""
_TURN = 0.7


def shape(case: ReconstructorCase) -> None:
    """Check that the registry lets the reconstructor in."""
    check_shape("reconstructor", case.reconstructor)


def options(case: ReconstructorCase) -> None:
    """Check that options are declared, bounded and refused when wrong."""
    check_options(case.reconstructor, case.options)


def reconstructs(case: ReconstructorCase) -> None:
    """Check that an announced product comes out, twice the same, and the input stays as it was."""
    for body, fresh in zip(case.bodies(), case.bodies(), strict=True):
        first = case.reconstruct(body)
        kinds = case.reconstructor.produces
        told = f"{type(first).__name__} is not one of {', '.join(kind.__name__ for kind in kinds)}"
        must(isinstance(first, kinds), told)
        must_be_same(first, case.reconstruct(body), "when made again")
        must_be_same(body, fresh, "after it was reconstructed")


def closed(case: ReconstructorCase) -> None:
    """Check that the surface is closed, oriented, finite, and that outside is outside."""
    for body in case.bodies():
        mesh = mesh_of(case.reconstruct(body))
        must(len(mesh.faces) > 0, "there is no surface")
        must(np.isfinite(mesh.vertices).all(), "vertices are not finite")
        must(mesh.faces.min() >= 0 and mesh.faces.max() < len(mesh.vertices), "a face names no vertex")
        loose = unmatched_edges(mesh.faces)
        must(loose == 0, f"{loose} edges are open, or their triangles disagree which side is out")
        volume, _ = mesh_integrals(mesh.vertices, mesh.faces)
        must(volume > 0, f"the surface is inside out: its volume is {volume:.4g} mm³")


def place(case: ReconstructorCase) -> None:
    """Check that the body lies where it lay, half a pixel or a dropped origin off being a fault."""
    for body in case.bodies(max(FINENESS)):
        off = np.linalg.norm(case.figures(body)[2] - ellipsoids.CENTRE)
        must(off <= case.place_tolerance, f"the body's centre lies {off:.3g} mm off")


def convergence(case: ReconstructorCase) -> None:
    """Check that volume and area approach the exact ones as sections or triangles get finer."""
    for kind in [type(body) for body in case.bodies()]:
        runs = [case.figures(ellipsoids.MAKERS[kind](fineness)) for fineness in FINENESS]
        for name, which, exact, tolerance in (
            ("volume", 0, ellipsoids.VOLUME, case.volume_tolerance),
            ("area", 1, ellipsoids.AREA, case.area_tolerance),
        ):
            errors = [abs(float(run[which]) / exact - 1.0) for run in runs]
            told = f"{name} from {kind.__name__} errs by {', '.join(f'{error:.2e}' for error in errors)}"
            must(errors[-1] <= tolerance, f"{told}: more than {tolerance:g} at the finest")
            finer = all(b <= max(a, case.settled) for a, b in pairwise(errors))
            must(finer, f"{told}: not less as the body gets finer")


def rigid_motion(case: ReconstructorCase) -> None:
    """Check that a body moved and turned about the axis keeps its figures, and is where it was moved to."""
    c, s = np.cos(_TURN), np.sin(_TURN)
    turn, shift = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), np.array([5.0, -90.0, 77.0])
    for body in case.bodies():
        _must_scale(case, body, transformed(body, turn, shift), 1.0, "a rigid motion")
        centre = case.figures(transformed(body, turn, shift))[2]
        off = np.linalg.norm(centre - (turn @ case.figures(body)[2] + shift))
        must(off <= case.place_tolerance, f"a moved body lies {off:.3g} mm from where it was moved to")


def affine(case: ReconstructorCase) -> None:
    """Check that a stack's affine is honoured: the body turns and moves with it."""
    turn = np.array([[0.0, -0.8, 0.6], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8]])
    shift = np.array([10.0, 20.0, -30.0])
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = turn, shift
    for body in case.bodies():
        if isinstance(body, ContourStack):
            moved = replace(body, affine=frozen_floats(move))
            _must_scale(case, body, moved, 1.0, "an affine that turns")
            off = np.linalg.norm(case.figures(moved)[2] - (turn @ case.figures(body)[2] + shift))
            must(off <= case.place_tolerance, f"the affine is not honoured: the body lies {off:.3g} mm off")


def scaling(case: ReconstructorCase) -> None:
    """Check that a body s times as large has s³ the volume and s² the area."""
    for body in case.bodies():
        for s in (1e-2, 2.5, 1e2):
            _must_scale(case, body, transformed(body, s * np.eye(3), np.zeros(3)), s, f"scaling by {s:g}")


def mirror(case: ReconstructorCase) -> None:
    """Check that a mirrored body has the same figures and is not inside out."""
    for body in case.bodies():
        _must_scale(case, body, transformed(body, np.diag([-1.0, 1.0, 1.0]), np.zeros(3)), 1.0, "mirroring")


def start_point(case: ReconstructorCase) -> None:
    """Check that where a loop (list, crop) starts changes nothing."""
    for body in case.bodies():
        for steps in (1, 5):
            _must_scale(case, body, started_elsewhere(body, steps), 1.0, f"starting {steps} later")


def direction(case: ReconstructorCase) -> None:
    """Check that a loop given clockwise counts as one given counter-clockwise."""
    for body in case.bodies():
        if isinstance(body, ContourStack):
            _must_scale(case, body, turned_over(body), 1.0, "running the loops the other way")


def additivity(case: ReconstructorCase) -> None:
    """Check that two bodies in one product have the sum of their figures, or are refused."""
    for body in case.bodies():
        must_add_up(body, lambda product: case.figures(product)[:2], case.steadiness)


def refusals(case: ReconstructorCase) -> None:
    """Check that a body of nothing, and a stack of one section, are refused."""
    for body in case.bodies():
        what = f"an empty {type(body).__name__}"
        must_refuse(lambda body=body: case.reconstruct(emptied(body)), what)  # type: ignore[misc]
        if isinstance(body, ContourStack):
            one = replace(body, sections=body.sections[:1])
            must_refuse(lambda one=one: case.reconstruct(one), "a stack of one section")  # type: ignore[misc]


def open_surfaces(case: ReconstructorCase) -> None:
    """Check that a surface with a triangle missing is refused or closed, not handed on."""
    for body in case.bodies():
        if not isinstance(body, TriMesh):
            continue  # loops and voxels are closed by what they are
        what, gap = opened(body)
        try:
            made = case.reconstruct(gap)
        except StackloftError:
            continue
        loose = unmatched_edges(mesh_of(made).faces)
        must(loose == 0, f"what is made of {what} has {loose} open edges")


def _must_scale(case: ReconstructorCase, body: Any, other: Any, s: float, what: str) -> None:
    before, after = case.figures(body), case.figures(other)
    for name, which, power in (("volume", 0, 3), ("area", 1, 2)):
        change = float(after[which]) / (float(before[which]) * s**power) - 1.0
        told = f"{what} of a {type(body).__name__} changes the {name} by {change:.1e} (of s^{power})"
        must(abs(change) <= case.steadiness, told)


CHECKS = {
    "plugin-shape": shape,
    "options-validated": options,
    "reconstructs": reconstructs,
    "closed": closed,
    "place": place,
    "convergence": convergence,
    "rigid-motion": rigid_motion,
    "affine": affine,
    "scaling": scaling,
    "mirror": mirror,
    "start-point": start_point,
    "direction": direction,
    "additivity": additivity,
    "refuses-empty": refusals,
    "open": open_surfaces,
}


def reconstructor_checks(
    case: ReconstructorCase, expected_failures: Mapping[str, str] | None = None
) -> list[Check]:
    """Return the checks of one reconstructor.

    Parameters
    ----------
    case : ReconstructorCase
        The reconstructor, its options and tolerances.
    expected_failures : mapping, optional
        Reasons by check for those that this reconstructor may break; it must then really break them.
    """
    return suite(CHECKS, case, expected_failures or {})
