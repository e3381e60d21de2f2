"""Cavalieri's coefficient of error against what systematic sampling really costs."""

import numpy as np
import pytest

from stackloft.geometry.systematic_sampling import alpha, sampling_precision
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.testing import phantoms
from stackloft_plugins.integrators.cavalieri import Cavalieri


def sums(area, m, phases):
    """Σ area at m (or m ± 1) equally spaced places in (0, 1), for each phase; and the estimated CE."""
    found = []
    for phase in phases:
        z = (np.arange(m + 1) + phase) / m
        areas = area(z[z < 1])
        found.append((areas.sum() / m, sampling_precision(areas).coefficient_of_error))
    return np.array(found)


PHASES = (np.arange(400) + 0.5) / 400


@pytest.mark.parametrize("m", [7, 15, 40])
def test_an_ellipsoid_errs_by_one_over_root_five_m_squared(m):
    found = sums(lambda z: 6 * z * (1 - z), m, PHASES)
    real = found[:, 0].std() / found[:, 0].mean()
    assert real == pytest.approx(1 / (np.sqrt(5) * m**2), rel=0.02)
    told = np.sqrt((found[:, 1] ** 2).mean())
    assert 0.6 < told / real < 2.0


@pytest.mark.parametrize("m", [10, 30])
def test_a_body_that_ends_in_plane_faces_errs_by_the_rougher_class(m):
    # a prism of incommensurable length: areas jump at both ends
    length = 1 - 0.37 / m
    found = sums(lambda z: np.where(z < length, 1.0, 0.0), m, PHASES)
    real = found[:, 0].std() / found[:, 0].mean()
    told = np.sqrt((found[:, 1] ** 2).mean())
    assert 0.5 < told / real < 2.0
    assert sampling_precision(np.ones(m)).smoothness < 0.1


def test_the_smoothness_class_is_told_apart():
    z = (np.arange(41) + 0.4) / 41
    assert sampling_precision(z * (1 - z)).smoothness > 0.9
    assert sampling_precision(np.sqrt(z * (1 - z))).smoothness < 0.95
    assert sampling_precision(np.ones(41)).smoothness < 0.1


def test_alpha_between_its_known_ends_is_continuous_and_falling():
    values = [alpha(q) for q in np.linspace(0, 1, 41)]
    assert np.all(np.diff(values) < 0)
    assert (values[0], values[-1]) == pytest.approx((1 / 12, 1 / 240))


def test_few_or_uneven_sections_tell_no_precision():
    assert sampling_precision(np.ones(4)) is None
    t = 2 * np.pi * np.arange(60) / 60
    ring = 5 * np.column_stack([np.cos(t), np.sin(t)])

    def stack(z):
        return ContourStack(tuple(Section(float(x), (Loop(ring),), str(x)) for x in z))

    assert Cavalieri().integrate(stack([0, 1, 2, 4, 5, 6])).volume_uncertainty is None
    told = Cavalieri().integrate(stack(range(6)))
    assert told.volume_uncertainty == pytest.approx(told.details["coefficient_of_error"] * told.volume)


def test_a_real_figure_lies_within_a_few_standard_uncertainties():
    body = phantoms.make("potato", seed=3, rotation=5)
    low, high = body.extent()
    pitch = (high - low) / 12
    ratios = []
    for phase in (0.15, 0.4, 0.65, 0.9):
        places = np.arange(low + phase * pitch, high, pitch)
        found = Cavalieri().integrate(body.contour_stack(placing=list(places)))
        ratios.append((found.volume - body.volume) / found.volume_uncertainty)
    assert np.abs(ratios).max() < 3
