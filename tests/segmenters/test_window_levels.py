"""Whole sixty-fourths of a grey level tell what floating point numbers tell."""

import weakref

import numpy as np
import pytest

from stackloft_plugins.segmenters.flat_field import Light
from stackloft_plugins.segmenters.slice_field import LevelRules, begun_field, slice_field
from stackloft_plugins.segmenters.window_levels import window_levels

SHAPE = (310, 420)
WINDOW = np.s_[7:301, 20:400]


def scene(body=80.0, plate=225.0):
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    inside = np.clip(100.0 - np.hypot((x - 200) / 1.2, y - 150), 0, 1)
    light = 1.0 + 0.08 * (x / SHAPE[1] - 0.5) - 0.05 * (y / SHAPE[0] - 0.5) ** 2
    noise = np.random.default_rng(3).normal(0, 2, SHAPE)
    return ((plate + (body - plate) * inside) * light + noise).clip(0, 255).astype(np.uint8)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("light", [None, Light(np.array([1.0, 0.04, -0.03, 0.02, 0.01, 0.0]), SHAPE)])
def test_the_same_levels_to_half_a_part(sign, light):
    picture = scene()
    whole, unit = window_levels(picture, WINDOW, "luminance", sign, light)
    fine, one = window_levels(picture.astype(np.float32), WINDOW, "luminance", sign, light)
    assert (whole.dtype, fine.dtype, one) == (np.int16, np.float32, 1.0)
    assert np.abs(whole * unit - fine).max() <= 0.51 * unit


@pytest.mark.parametrize("body", [80.0, 190.0])
def test_the_same_body(body):
    picture = scene(body)
    whole, fine = (slice_field(own, LevelRules(), "a.png") for own in (picture, picture.astype(np.float32)))
    assert whole.threshold == pytest.approx(fine.threshold, abs=0.0015 * (225.0 - body))  # settled to 0.001
    assert whole.level * whole.unit == pytest.approx(-whole.threshold, abs=1e-3)
    assert whole.offset == fine.offset
    assert np.count_nonzero(whole.above()) == pytest.approx(np.count_nonzero(fine.above()), rel=3e-4)


def test_the_picture_may_go_before_the_field_is_made():
    picture = scene()
    given, gone = slice_field(picture, LevelRules(), "a.png"), weakref.ref(picture)
    rest = begun_field(picture, LevelRules(), "a.png")
    del picture
    assert gone() is None
    assert np.array_equal(rest().values, given.values)
