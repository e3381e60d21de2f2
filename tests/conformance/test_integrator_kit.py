"""The integrator checks let correct integrators through and catch seeded faults, each by its name."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from stackloft.contracts.options import option
from stackloft.geometry.shoelace import polygon_area
from stackloft.model.arrays import frozen_floats
from stackloft.model.contour_stack import ContourStack
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.measurement import Integral
from stackloft.model.tri_mesh import TriMesh
from stackloft.testing.conformance import ellipsoids
from stackloft.testing.conformance.check import findings
from stackloft.testing.conformance.integrator_checks import CHECKS, IntegratorCase, integrator_checks
from stackloft.testing.conformance.moving import transformed


@dataclass(frozen=True)
class Rectangle:
    """Section area times pitch."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (ContourStack,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

    def integrate(self, product):
        if len(product) < 2:
            raise InputError("two sections are needed", found=f"{len(product)}")
        return Integral(float(self.areas(product) @ self.pitches(product.positions)), None)

    def areas(self, product):
        return np.array([sum(abs(polygon_area(x.points)) for x in s.loops) for s in product.sections])

    def pitches(self, z):
        return np.gradient(z)


@dataclass(frozen=True)
class Polyhedral:
    """Signed tetrahedra and triangle areas of a closed surface."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TriMesh,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

    def integrate(self, product):
        self.check(product)
        a, b, c = self.corners(product)
        cross = np.cross(b - a, c - a)
        volume = float((a * cross).sum() / 6)
        if volume <= 0:
            raise InputError("the surface is inside out")
        return Integral(volume, float(np.linalg.norm(cross, axis=1).sum() / 2))

    def corners(self, product):
        vertices = product.vertices - product.vertices.mean(axis=0)
        return (vertices[product.faces[:, k]] for k in range(3))

    def check(self, product):
        edges = {(int(f[i]), int(f[(i + 1) % 3])) for f in product.faces for i in range(3)}
        if not edges or any((b, a) not in edges for a, b in edges):
            raise InputError("the surface is not closed")


def volume(part):
    """Return a fault in which `part` replaces the volume of the integral."""
    return lambda integral, product: replace(integral, volume=part(integral, product))


def faulty(base, change, name):
    def integrate(self, product):
        return change(base.integrate(self, product), product)

    return dataclass(frozen=True)(type(name, (base,), {"integrate": integrate}))


class UnitPitch(Rectangle):
    def pitches(self, z):
        return np.ones_like(z)


class SignedAreas(Rectangle):
    def areas(self, product):
        return np.array([sum(polygon_area(loop.points) for loop in s.loops) for s in product.sections])


class ForgetsTheLastPoint(Rectangle):
    def areas(self, product):
        return np.array([sum(abs(polygon_area(x.points[:-1])) for x in s.loops) for s in product.sections])


class BoundingBoxes(Rectangle):
    def areas(self, product):
        return np.array([np.ptp(s.loops[0].points, axis=0).prod() * np.pi / 4 for s in product.sections])


class OnlyBodiesRightOfTheOrigin(Rectangle):
    def areas(self, product):
        return np.array([abs(polygon_area(np.maximum(s.loops[0].points, 0))) for s in product.sections])


class FewPoints(Rectangle):
    def areas(self, product):
        return np.array([abs(polygon_area(s.loops[0].points[::8])) for s in product.sections])


class CrashesOnNothing(Rectangle):
    def integrate(self, product):
        return Integral(float(self.areas(product) @ self.pitches(product.positions)), None)


class MeasuresNothingAsZero(Rectangle):
    def integrate(self, product):
        return super().integrate(product) if len(product) > 1 else Integral(0.0, None)


class Accumulates(Rectangle):
    total: ClassVar[list] = []

    def integrate(self, product):
        self.total.append(super().integrate(product).volume)
        return Integral(sum(self.total), None)


class SpoilsItsInput(Rectangle):
    def integrate(self, product):
        integral = super().integrate(product)
        for section in product.sections:
            section.loops[0].points.setflags(write=True)
            section.loops[0].points[...] *= 1.0 + 1e-3
        return integral


class ReturnsATuple(Rectangle):
    def integrate(self, product):
        return (super().integrate(product).volume, None)


class RoundsToMillimetres(Rectangle):
    def integrate(self, product):
        return Integral(round(super().integrate(product).volume, 0), None)


class NeglectsTheAffine(Rectangle):
    """Takes the affine's turned diagonal for a scale."""

    def integrate(self, product):
        return Integral(super().integrate(product).volume * abs(product.affine[2, 2]), None)


class LargestLoopOnly(Rectangle):
    def areas(self, product):
        return np.array([max(abs(polygon_area(x.points)) for x in s.loops) for s in product.sections])


class InsideOutWillDo(Polyhedral):
    def integrate(self, product):
        self.check(product)
        a, b, c = self.corners(product)
        return Integral(float((a * np.cross(b - a, c - a)).sum() / 6), None)


class OpenSurfaceWillDo(Polyhedral):
    def check(self, product):
        if not len(product.faces):
            raise InputError("no surface")


class NotCentred(OpenSurfaceWillDo):
    """Leaves out triangles that look at the origin, as hand-made convex hull code does."""

    def integrate(self, product):
        self.check(product)
        a, b, c = (product.vertices[product.faces[:, k]] for k in range(3))
        parts = (a * np.cross(b - a, c - a)).sum(axis=1) / 6
        return Integral(float(parts[parts > 0].sum()), Polyhedral().integrate(product).area)


@dataclass(frozen=True)
class Bounded(Rectangle):
    order: int = option(2, "order", ge=1)

    def __post_init__(self):
        if self.order > 2:
            raise InputError("order too high")


@dataclass(frozen=True)
class WithoutHelp(Rectangle):
    order: int = 2


FAULTS = {
    UnitPitch: "scaling",
    SignedAreas: "mirror",
    ForgetsTheLastPoint: "start-point",
    BoundingBoxes: "rigid-motion",
    OnlyBodiesRightOfTheOrigin: "rigid-motion",
    FewPoints: "start-point",
    CrashesOnNothing: "refuses-empty",
    MeasuresNothingAsZero: "refuses-empty",
    Accumulates: "figures",
    SpoilsItsInput: "figures",
    ReturnsATuple: "figures",
    RoundsToMillimetres: "scaling",
    NeglectsTheAffine: "affine-motion",
    LargestLoopOnly: "additivity",
    InsideOutWillDo: "orientation",
    OpenSurfaceWillDo: "refuses-open",
    NotCentred: "rigid-motion",
    WithoutHelp: "options-validated",
    faulty(Rectangle, volume(lambda x, _: x.volume ** (2 / 3)), "SquareForCube"): "scaling",
    faulty(Rectangle, volume(lambda x, _: x.volume / 1000), "CubicCentimetres"): "convergence",
    faulty(Rectangle, volume(lambda x, _: 1.02 * x.volume), "TwoPercentHigh"): "convergence",
    faulty(Rectangle, volume(lambda x, _: float("nan")), "NotANumber"): "figures",
    faulty(Rectangle, volume(lambda x, _: -x.volume), "SignLost"): "figures",
    faulty(Rectangle, volume(lambda x, _: None), "NothingAtAll"): "figures",
    faulty(Rectangle, volume(lambda x, p: x.volume + p.positions[0]), "DependsOnThePlace"): "rigid-motion",
    faulty(Polyhedral, lambda x, _: Integral(x.area, x.volume), "AreaForVolume"): "scaling",
    faulty(Polyhedral, lambda x, _: replace(x, area=x.area / 2), "HalfTheArea"): "convergence",
    faulty(
        Polyhedral, volume(lambda x, p: x.volume * (1 + 1e-7 * p.vertices[0, 0])), "SlightlyOff"
    ): "rigid-motion",
}


@pytest.mark.parametrize("integrator", [Rectangle, Polyhedral, Bounded])
@pytest.mark.parametrize("name", CHECKS)
def test_correct_integrators_pass(integrator, name):
    next(check for check in integrator_checks(IntegratorCase(integrator)) if check.name == name)()


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_seeded_faults_are_caught(fault):
    failed = {
        finding.check: finding.reason
        for finding in findings(integrator_checks(IntegratorCase(fault)))
        if not finding.passed
    }
    assert FAULTS[fault] in failed
    assert failed[FAULTS[fault]]


def test_an_integrator_of_unknown_products_is_told_so():
    strange = dataclass(frozen=True)(type("Strange", (Rectangle,), {"accepts": (int,)}))
    reasons = {
        finding.check: finding.reason for finding in findings(integrator_checks(IntegratorCase(strange)))
    }
    assert "the kit has no body of a type" in reasons["convergence"]


def test_the_kit_s_own_bodies_are_what_they_claim():
    """Volume and area by quadrature of the parametrised ellipsoid; loft and mesh touch it."""
    from scipy.integrate import dblquad  # noqa: PLC0415

    a, b = ellipsoids.A, ellipsoids.B

    def element(polar, angle):
        x, y, z = np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar)
        return np.sin(polar) * a * b * b * np.sqrt((x / a) ** 2 + (y / b) ** 2 + (z / b) ** 2)

    area = dblquad(element, 0, 2 * np.pi, 0, np.pi, epsabs=0, epsrel=1e-10)[0]
    assert abs(ellipsoids.AREA / area - 1) < 1e-9
    for points in (
        ellipsoids.lofted_solid(8).shells[0].patches[..., 0, 0, :].reshape(-1, 3),
        ellipsoids.tri_mesh(2).vertices,
    ):
        local = (points - ellipsoids.CENTRE) / (a, b, b)
        assert np.linalg.norm(local, axis=1) == pytest.approx(1.0, abs=1e-12)


def test_a_stack_cannot_be_tilted_by_moving_its_points():
    with pytest.raises(ValueError, match="keeps its axis"):
        transformed(ellipsoids.contour_stack(1), np.diag([1.0, 1.0, -1.0]), np.zeros(3))
    with pytest.raises(NotImplementedError, match="no way to move a int"):
        transformed(3, np.eye(3), np.zeros(3))


def test_mirroring_a_loft_keeps_it_outward():
    solid = ellipsoids.lofted_solid(1)
    mirrored = transformed(solid, np.diag([-1.0, 1.0, 1.0]), np.zeros(3))
    assert isinstance(mirrored, LoftedSolid)
    twice = transformed(mirrored, np.diag([-1.0, 1.0, 1.0]), np.zeros(3))
    assert frozen_floats(twice.shells[0].patches) == pytest.approx(solid.shells[0].patches)
