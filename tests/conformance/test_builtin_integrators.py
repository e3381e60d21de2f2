"""The built-in integrators pass the kit that strangers run."""

import pytest

from stackloft.registry import find
from stackloft.testing.conformance.integrator_checks import IntegratorCase, integrator_checks


def checks(name, expected_failures=None, **options):
    return integrator_checks(IntegratorCase(find("integrator", name).plugin, options), expected_failures)


THIRTEEN = {
    "convergence": "13 directions sample the sphere once and for all: the ellipsoid's area settles 0.33 % off"
}
FRUSTA = {
    "convergence": "conical frusta know a section's area and perimeter alone, so that their area stays "
    "4.6 % off on sections with axes 1.75 : 1 however fine they are"
}


@pytest.mark.parametrize("check", checks("surface-gauss"), ids=str)
def test_surface_gauss(check):
    check()


@pytest.mark.parametrize("check", checks("cavalieri"), ids=str)
def test_cavalieri_rectangle(check):
    check()


@pytest.mark.parametrize("check", checks("cavalieri", rule="trapezoid"), ids=str)
def test_cavalieri_trapezoid(check):
    check()


@pytest.mark.parametrize("check", checks("voxel"), ids=str)
def test_voxel(check):
    check()


@pytest.mark.parametrize("check", checks("partial-volume"), ids=str)
def test_partial_volume(check):
    check()


@pytest.mark.parametrize("check", checks("crofton"), ids=str)
def test_crofton(check):
    check()


@pytest.mark.parametrize("check", checks("crofton", THIRTEEN, directions="13"), ids=str)
def test_crofton_with_13_directions(check):
    check()


@pytest.mark.parametrize("check", checks("polyhedral"), ids=str)
def test_polyhedral(check):
    check()


@pytest.mark.parametrize("check", checks("frustum", FRUSTA), ids=str)
def test_frustum(check):
    check()
