"""Uneven light over a bright plate is divided away; what is no light is left alone."""

import numpy as np
import pytest

from stackloft_plugins.segmenters.flat_field import fit_light
from stackloft_plugins.segmenters.slice_field import LevelRules, slice_field

SHAPE = (200, 260)
Y, X = np.mgrid[-1 : 1 : SHAPE[0] * 1j, -1 : 1 : SHAPE[1] * 1j]
DISC = np.hypot(X * 130, Y * 100) < 60


def picture(light, body=150.0, plate=230.0):
    return (np.where(DISC, body, plate) * light).astype(np.float32)


def test_a_quadratic_light_is_divided_away_exactly():
    light = 1 - 0.1 * X + 0.04 * Y - 0.08 * (X * X + Y * Y)
    grey = picture(light)
    found = fit_light(grey, DISC.astype(np.uint8), 1, SHAPE)
    flat = found.flattened(grey, np.s_[:, :])
    assert np.ptp(flat[~DISC]) < 0.05
    assert np.ptp(flat[DISC]) < 0.05


def test_shadows_and_debris_do_not_bend_it():
    rng = np.random.default_rng(0)
    light = 1 - 0.08 * X
    grey = picture(light) + rng.normal(0, 1, SHAPE).astype(np.float32)
    grey[20:60, 20:60] -= 60
    found = fit_light(grey, DISC.astype(np.uint8), 1, SHAPE)
    flat = found.flattened(picture(light), np.s_[:, :])
    assert np.ptp(flat[~DISC]) < 1.5


def test_no_plate_or_no_light_is_no_answer():
    assert fit_light(picture(1.0), np.ones(SHAPE, np.uint8), 1, SHAPE) is None
    assert fit_light(picture(1 - 0.9 * X), DISC.astype(np.uint8), 1, SHAPE) is None
    halves = np.where(X < 0, 20.0, 230.0).astype(np.float32)
    assert fit_light(halves, np.zeros(SHAPE, np.uint8), 1, SHAPE) is None


@pytest.mark.parametrize("fall", [0.0, 0.1, 0.25])
def test_a_pale_body_under_uneven_light_keeps_its_area(fall):
    light = 1 - fall * (0.5 * X + 0.25 * (X * X + Y * Y))
    field = slice_field(picture(light, body=190.0), LevelRules(), "a.png")
    area = (field.values > field.level).sum()
    assert area == pytest.approx(DISC.sum(), rel=0.01)
