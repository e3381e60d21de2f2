import numpy as np
import pytest
from scipy.optimize import brentq

from stackloft.geometry.voxel_mean import SurfaceShape, half_way_shift


def half_full(angle, slope, bend, twist, curvature, box):
    """Return where a voxel is half full, by counting points in it."""
    x, y, z = np.meshgrid(*((np.arange(60) + 0.5) / 60 * side - side / 2 for side in box), indexing="ij")
    p = x * np.cos(angle) + y * np.sin(angle)
    q = y * np.cos(angle) - x * np.sin(angle)
    surface = slope * z + 0.5 * bend * z**2 + twist * q * z - 0.5 * curvature * q**2
    steps = 400.0 / min(box)  # a step function, made smooth over a part of a pixel to find its root

    def above(shift):
        return float(np.tanh(steps / 10 * (surface - p - shift)).mean())

    return brentq(above, -0.5, 0.5)


@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 4, 2.0])
@pytest.mark.parametrize("slope", [0.0, 0.2, 0.7, 2.0])
def test_the_shift_is_where_a_voxel_is_half_full(angle, slope):
    shape = (slope, 0.02, 0.015, 0.05)
    box = (1.0, 1.0, 3.0)
    normal = np.array([[np.cos(angle), np.sin(angle)]])
    surface = SurfaceShape(normal, *(np.array([value]) for value in shape))
    shift = half_way_shift(surface, np.array([box]))[0]
    assert shift == pytest.approx(half_full(angle, *shape, box), abs=1.5e-3)


def test_every_round_outline_loses_a_third_of_a_pixel():
    angle = np.linspace(0.0, 2 * np.pi, 4000, endpoint=False)
    none = np.zeros_like(angle)
    for radius in (5.0, 50.0):
        round_ = SurfaceShape(
            np.column_stack([np.cos(angle), np.sin(angle)]), none, none, none, none + 1 / radius
        )
        lost = half_way_shift(round_, np.ones((len(angle), 3))).mean() * 2 * np.pi * radius
        assert lost == pytest.approx(-1.0 / 3.0, rel=1e-4)
