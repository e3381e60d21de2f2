"""What is worked out for many sections at once is what each gives by itself."""

import numpy as np
import pytest

from stackloft.geometry.odd_moments import HIGHEST, central_moment_ratios
from stackloft.geometry.patch_integrals import patch_areas, volume_and_area
from stackloft.geometry.shoelace import polygon_area, polygon_centroid, polygon_perimeter
from stackloft.geometry.skin import Rows, skin
from stackloft.geometry.swept_area import areas_beyond


def blob(rng, count=40):
    t = 2 * np.pi * np.arange(count) / count
    radius = 9.0 + sum(rng.normal(0, 1.0 / k**2) * np.cos(k * t + rng.uniform(0, 6)) for k in range(1, 5))
    return np.column_stack([radius * np.cos(t), 0.7 * radius * np.sin(t)]) + rng.normal(0, 30, 2)


@pytest.mark.parametrize("degree", [4, 9])
def test_areas_of_patches_sum_to_the_whole(degree):
    patches = np.random.default_rng(3).normal(0.0, 1.0, (3, 700, 4, 4, 3))  # more than are taken at once
    areas = patch_areas(patches, degree)
    assert areas.shape == (3, 700)
    assert areas.sum() == pytest.approx(volume_and_area(patches, np.zeros(3), degree)[1], rel=1e-12)
    assert areas[1, 5] == pytest.approx(volume_and_area(patches[1, 5], np.zeros(3), degree)[1], rel=1e-12)


def test_a_row_that_slips_is_found_among_sound_ones():
    rng = np.random.default_rng(5)
    ring = blob(rng, 24) - 3.0
    rows = np.array([np.column_stack([ring * (1 + 0.01 * k), np.full(24, 1.0 * k)]) for k in range(9)])
    rows[6:, :, :2] = np.roll(rows[6:, :, :2], 6, axis=1)

    def beyond(points):
        marks = np.zeros(points.shape[:2], bool), np.zeros(len(points), bool)
        return areas_beyond(skin(Rows(points, *marks, (None, None))))

    every, whole = beyond(rows)
    assert np.flatnonzero(every > 0.002 * whole).tolist() == [5]
    sound, whole = beyond(rows[:5])
    assert sound.max() <= 2e-4 * whole


def test_moments_are_those_of_each_triangle_of_a_fan():
    """∫ x^p y^q over triangles by a rule exact to degree 6, from the first vertex on."""
    rng = np.random.default_rng(8)
    loops, z, weights = (
        [blob(rng, n) for n in (5, 40, 33)],
        np.array([0.0, 2.0, 3.5]),
        np.array([1.0, 1.5, 2.0]),
    )
    powers = [(p, q, r) for p in range(HIGHEST) for q in range(HIGHEST - p) for r in (0, 1)]
    nodes, scale = np.polynomial.legendre.leggauss(4)
    u, v = np.meshgrid(0.5 + 0.5 * nodes, 0.5 + 0.5 * nodes)
    rule = 0.25 * np.outer(scale, scale) * u
    mass = np.array([polygon_area(loop) for loop in loops]) * weights
    centre = sum(m * polygon_centroid(loop) for m, loop in zip(mass, loops, strict=True)) / mass.sum()
    height = z - mass @ z / mass.sum()

    def moment(loop, p, q):
        total, (x0, y0) = 0.0, loop[0] - centre
        for a, b in zip(loop[1:-1] - loop[0], loop[2:] - loop[0], strict=True):
            x, y = (start + u * (a[k] + v * (b[k] - a[k])) for k, start in enumerate((x0, y0)))
            total += (a[0] * b[1] - a[1] * b[0]) * float((rule * x**p * y**q).sum())
        return total

    def whole(p, q, r):
        parts = zip(loops, weights, height, strict=True)
        return sum(w * h**r * moment(loop, p, q) for loop, w, h in parts)

    radius = np.sqrt((whole(2, 0, 0) + whole(0, 2, 0)) / mass.sum())
    tall = np.sqrt((mass * height**2).sum() / mass.sum())
    expected = [whole(p, q, r) / (mass.sum() * radius ** (p + q) * tall**r) for p, q, r in powers]
    assert central_moment_ratios(loops, z, weights, powers) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("order", ["C", "F"])
def test_polygons_are_measured_however_they_lie_in_memory(order):
    loop = blob(np.random.default_rng(2))
    edges = np.roll(loop, -1, axis=0) - loop
    assert polygon_perimeter(np.array(loop, order=order)) == pytest.approx(
        np.hypot(*edges.T).sum(), rel=1e-14
    )
    cross = 0.5 * (loop[:, 0] * np.roll(loop[:, 1], -1) - loop[:, 1] * np.roll(loop[:, 0], -1)).sum()
    assert polygon_area(np.array(loop, order=order)) == pytest.approx(cross, rel=1e-12)
    assert polygon_area(loop[::-1]) == pytest.approx(-cross, rel=1e-12)
