"""Cavalieri and frustums against closed forms and their own theory."""

import numpy as np
import pytest

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft_plugins.integrators.cavalieri import Cavalieri
from stackloft_plugins.integrators.frustum import Frustum


def circle(radius, count=200):
    t = 2 * np.pi * np.arange(count) / count
    return radius * np.stack([np.cos(t), np.sin(t)], axis=1)


def stack(radii, z, **more):
    return ContourStack(
        tuple(Section(float(h), (Loop(circle(r)),), f"z{h}") for r, h in zip(radii, z, strict=True)), **more
    )


@pytest.mark.parametrize("m", [5, 11, 20])
def test_cavalieri_errs_on_a_ball_as_theory_says(m):
    z = -10 + 20 * (np.arange(m) + 0.5) / m
    found = Cavalieri().integrate(stack(np.sqrt(100 - z**2), z)).volume
    assert found / (4000 / 3 * np.pi) - 1 == pytest.approx(1 / (2 * m**2), rel=1e-4)


def test_trapezoid_stops_at_the_outermost_sections():
    z = np.array([0.0, 1.0, 4.0])
    found = Cavalieri(rule="trapezoid").integrate(stack([5.0, 5.0, 5.0], z))
    assert found.volume == pytest.approx(25 * np.pi * 4, rel=1e-6)
    assert found.area is None
    rectangle = Cavalieri().integrate(stack([5.0, 5.0, 5.0], z))
    assert rectangle.volume == pytest.approx(25 * np.pi * 6, rel=1e-6)


def test_frustums_are_exact_on_a_cone_frustum():
    z = np.array([0.0, 2.0, 7.0])
    found = Frustum().integrate(stack(10 - z, z))
    assert found.volume == pytest.approx(np.pi * (1000 - 27) / 3, rel=1e-6)
    assert found.area == pytest.approx(np.pi * (100 + 9 + 13 * np.sqrt(2) * 7), rel=1e-6)


def test_frustums_of_a_ball_converge_with_second_order_from_below():
    errors = []
    for m in (9, 17, 33):
        z = np.linspace(-9.0, 9.0, m)
        exact = np.pi * (100 * 18 - 2 * 9**3 / 3)
        errors.append(1 - Frustum().integrate(stack(np.sqrt(100 - z**2), z)).volume / exact)
    assert min(errors) > 0
    assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(2.0, abs=0.1)


def test_holes_count_against_the_area():
    ring = (Loop(circle(10.0)), Loop(circle(4.0)[::-1], hole=True))
    both = ContourStack((Section(0.0, ring, "a"), Section(2.0, ring, "b")))
    assert Cavalieri().integrate(both).volume == pytest.approx(84 * np.pi * 4, rel=1e-6)


def test_shear_leaves_cavalieri_alone_and_stops_frustums():
    shear = np.eye(4)
    shear[0, 2] = 0.5
    straight = stack([5, 6, 5], [0, 1, 2])
    sheared = stack([5, 6, 5], [0, 1, 2], affine=shear)
    assert Cavalieri().integrate(sheared).volume == pytest.approx(Cavalieri().integrate(straight).volume)
    with pytest.raises(InputError, match="unsheared"):
        Frustum().integrate(sheared)


@pytest.mark.parametrize("integrator", [Cavalieri(), Cavalieri(rule="trapezoid"), Frustum()])
def test_nothing_to_measure_is_refused(integrator):
    with pytest.raises(InputError):
        integrator.integrate(ContourStack((Section(0.0, (Loop(circle(3)),), "a"),)))
    with pytest.raises(InputError):
        integrator.integrate(ContourStack((Section(0.0, (), "a"), Section(1.0, (), "b"))))


@pytest.mark.parametrize("integrator", [Cavalieri(), Frustum()])
@pytest.mark.parametrize("scale", [0.01, 3.0])
def test_scaling(integrator, scale):
    radii, z = np.array([4.0, 6.0, 5.0]), np.array([0.0, 2.0, 5.0])
    one, other = integrator.integrate(stack(radii, z)), integrator.integrate(stack(scale * radii, scale * z))
    assert other.volume == pytest.approx(scale**3 * one.volume, rel=1e-10)
    if one.area is not None:
        assert other.area == pytest.approx(scale**2 * one.area, rel=1e-10)


def test_holes_have_frustums_of_their_own():
    """A cone frustum with a conical hole: both sides slant, each as it does."""
    sections = [
        Section(z, (Loop(circle(10 - z)), Loop(circle(2 + z)[::-1], hole=True)), f"z{z}") for z in (0.0, 3.0)
    ]
    found = Frustum().integrate(ContourStack(tuple(sections)))
    sides = np.pi * (17 + 7) * 3 * np.sqrt(2)
    assert found.area == pytest.approx(sides + np.pi * (100 - 4 + 49 - 25), rel=1e-6)


def test_a_cavity_that_begins_leaves_the_outer_side_upright():
    full, hollow = (Loop(circle(10.0)),), (Loop(circle(10.0)), Loop(circle(4.0)[::-1], hole=True))
    cuts = [full, hollow, hollow, full]
    found = Frustum().integrate(
        ContourStack(tuple(Section(float(k), c, f"z{k}") for k, c in enumerate(cuts)))
    )
    assert found.area == pytest.approx(np.pi * (2 * 100 + 20 * 3 + 8 * 2), rel=1e-6)
