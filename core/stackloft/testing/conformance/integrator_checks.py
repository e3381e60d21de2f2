"""Checks of integrators; run them with one pytest call.

::

    @pytest.mark.parametrize("check", integrator_checks(IntegratorCase(MyIntegrator)), ids=str)
    def test_my_integrator(check):
        check()
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import StackloftError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.measurement import Integral
from stackloft.model.segmentation import Segmentation
from stackloft.testing.conformance import ellipsoids
from stackloft.testing.conformance.adding import must_add_up
from stackloft.testing.conformance.check import Check, must, must_refuse, suite
from stackloft.testing.conformance.comparing import must_be_same
from stackloft.testing.conformance.integrator_case import IntegratorCase
from stackloft.testing.conformance.moving import (
    emptied,
    inside_out,
    opened,
    started_elsewhere,
    transformed,
    turned_over,
)
from stackloft.testing.conformance.option_checks import check_options, check_shape

FINENESS = (2, 4, 8)
"""Resolutions on which convergence is judged; each doubles the sections, patches or triangles."""


def shape(case: IntegratorCase) -> None:
    """Check that the registry lets the integrator in."""
    check_shape("integrator", case.integrator)


def options(case: IntegratorCase) -> None:
    """Check that options are declared, bounded and refused when wrong."""
    check_options(case.integrator, case.options)


def figures(case: IntegratorCase) -> None:
    """Check that an Integral with positive finite figures is returned, twice the same, input untouched."""
    for body, fresh in zip(case.bodies(), case.bodies(), strict=True):
        first = case.integrate(body)
        must(isinstance(first, Integral), f"{type(first).__name__} is returned, not an Integral")
        must(first.volume is not None or first.area is not None, "neither volume nor area is given")
        for name in ("volume", "area"):
            value = getattr(first, name)
            must(value is None or (math.isfinite(value) and value > 0), f"{name} is {value}")
        second = case.integrate(body)
        must((first.volume, first.area) == (second.volume, second.area), "a second run gives other figures")
        must_be_same(body, fresh, "after it was integrated")


def rigid_motion(case: IntegratorCase) -> None:
    """Check that moving and turning a body changes neither figure; a stack turns within its planes."""
    for body in case.bodies():
        turn = (
            _about_z(0.7)
            if isinstance(body, ContourStack)
            else _about_z(0.7) @ _about_x(1.1) @ _about_z(-0.4)
        )
        _must_scale(case, body, transformed(body, turn, np.array([5.0, -900.0, 77.0])), 1.0, "a rigid motion")


def affine_motion(case: IntegratorCase) -> None:
    """Check that turning the patient in the scanner's frame (the affine) changes neither figure."""
    for body in case.bodies():
        if isinstance(body, (ContourStack, LoftedSolid)):
            affine = np.eye(4)
            affine[:3, :3], affine[:3, 3] = _about_x(0.9) @ _about_z(2.0), (10.0, 20.0, -30.0)
            _must_scale(case, body, replace(body, affine=frozen_floats(affine)), 1.0, "an affine that turns")


def scaling(case: IntegratorCase) -> None:
    """Check that a body s times as large has s³ the volume and s² the area, from µm to m."""
    for body in case.bodies():
        for s in (1e-3, 2.5, 1e3):
            _must_scale(case, body, transformed(body, s * np.eye(3), np.zeros(3)), s, f"scaling by {s:g}")


def mirror(case: IntegratorCase) -> None:
    """Check that a mirrored body has the same figures."""
    for body in case.bodies():
        _must_scale(case, body, transformed(body, np.diag([-1.0, 1.0, 1.0]), np.zeros(3)), 1.0, "mirroring")


def start_point(case: IntegratorCase) -> None:
    """Check that where a loop starts changes nothing."""
    for body in case.bodies():
        for steps in (1, 5):
            _must_scale(case, body, started_elsewhere(body, steps), 1.0, f"starting {steps} points later")


def direction(case: IntegratorCase) -> None:
    """Check that a loop given clockwise counts as one given counter-clockwise."""
    for body in case.bodies():
        if isinstance(body, ContourStack):
            _must_scale(case, body, turned_over(body), 1.0, "running the loops the other way")


def orientation(case: IntegratorCase) -> None:
    """Check that a body turned inside out is refused or has the same figures: never negative ones."""
    for body in case.bodies():
        if isinstance(body, (ContourStack, Segmentation)):
            continue  # loops count either way round (`direction`), voxels have no inside out
        try:
            found = case.integrate(inside_out(body))
        except StackloftError:
            continue
        told = f"a {type(body).__name__} turned inside out has"
        for name in ("volume", "area"):
            before, after = getattr(case.integrate(body), name), getattr(found, name)
            same = before is None or math.isclose(after, before, rel_tol=case.exactness)
            must(same, f"{told} {name} {after}, not {before}")


def additivity(case: IntegratorCase) -> None:
    """Check that two bodies in one product have the sum of their figures, or are refused."""
    for body in case.bodies():
        must_add_up(body, case.figures, case.exactness)


def refusals(case: IntegratorCase) -> None:
    """Check that a body of nothing, and a stack of one section, are refused."""
    for body in case.bodies():
        kind = type(body).__name__
        must_refuse(lambda body=body: case.integrate(emptied(body)), f"an empty {kind}")  # type: ignore[misc]
        if isinstance(body, ContourStack):
            one = replace(body, sections=body.sections[:1])
            must_refuse(lambda one=one: case.integrate(one), "a stack of one section")  # type: ignore[misc]


def open_bodies(case: IntegratorCase) -> None:
    """Check that a solid or surface with a piece missing is refused, not measured."""
    for body in case.bodies():
        if isinstance(body, (ContourStack, Segmentation)):
            continue  # loops and voxels are closed by what they are
        what, gap = opened(body)
        must_refuse(lambda gap=gap: case.integrate(gap), what)  # type: ignore[misc]


def convergence(case: IntegratorCase) -> None:
    """Check that figures approach the exact ones as sections, patches, triangles or voxels get finer.

    A scan is integrated at several places among its voxels, and the root mean square error must fall:
    at one place alone the error is a matter of chance, and may be near 0 on a coarse scan.
    """
    for kind in [type(body) for body in case.bodies()]:
        runs = [[case.integrate(body) for body in _cases(kind, fineness)] for fineness in FINENESS]
        for name, exact, tolerance in (
            ("volume", ellipsoids.VOLUME, case.volume_tolerance),
            ("area", ellipsoids.AREA, case.area_tolerance),
        ):
            values = [[getattr(integral, name) for integral in run] for run in runs]
            if any(None in run for run in values):
                continue
            errors = [math.hypot(*(v / exact - 1 for v in run)) / math.sqrt(len(run)) for run in values]
            told = f"{name} from {kind.__name__} errs by {', '.join(f'{error:.2e}' for error in errors)}"
            must(errors[-1] <= tolerance, f"{told}: more than {tolerance:g} at the finest")
            finer = all(b <= max(a, case.exactness) for a, b in pairwise(errors))
            must(finer, f"{told}: not less as the body gets finer")


def _cases(kind: type, fineness: int) -> list[Any]:
    return ellipsoids.segmentations(fineness) if kind is Segmentation else [ellipsoids.MAKERS[kind](fineness)]


def _must_scale(case: IntegratorCase, body: Any, other: Any, s: float, what: str) -> None:
    before, after = case.integrate(body), case.integrate(other)
    for name, power in (("volume", 3), ("area", 2)):
        expected, found = getattr(before, name), getattr(after, name)
        must((expected is None) == (found is None), f"{what} makes the {name} {found}")
        if expected is not None:
            change = found / (expected * s**power) - 1
            told = f"{what} of a {type(body).__name__} changes the {name} by {change:.1e} (of s^{power})"
            must(abs(change) <= case.exactness, told)


def _about_z(angle: float) -> FloatArray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _about_x(angle: float) -> FloatArray:
    return np.roll(_about_z(angle), 1, axis=(0, 1))


CHECKS = {
    "plugin-shape": shape,
    "options-validated": options,
    "figures": figures,
    "rigid-motion": rigid_motion,
    "affine-motion": affine_motion,
    "scaling": scaling,
    "mirror": mirror,
    "start-point": start_point,
    "direction": direction,
    "orientation": orientation,
    "additivity": additivity,
    "refuses-empty": refusals,
    "refuses-open": open_bodies,
    "convergence": convergence,
}


def integrator_checks(
    case: IntegratorCase, expected_failures: Mapping[str, str] | None = None
) -> list[Check]:
    """Return the checks of one integrator.

    Parameters
    ----------
    case : IntegratorCase
        The integrator, its options and tolerances.
    expected_failures : mapping, optional
        Reasons by check for those that this integrator may break; it must then really break them.
    """
    return suite(CHECKS, case, expected_failures or {})
