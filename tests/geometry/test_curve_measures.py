"""Curves' figures and the parts they are made of, against what they stand for."""

from __future__ import annotations

import numpy as np
import pytest

from stackloft.geometry.bezier_patch import bernstein, evaluate, patch_planes
from stackloft.geometry.curve_stack import fit_curves
from stackloft.geometry.hermite_segments import segment_tangents
from stackloft.geometry.patch_integrals import patch_areas, volume_and_area
from stackloft.geometry.point_density import Spread
from stackloft.geometry.polygon_distance import inside_grid
from stackloft.geometry.shoelace import polygon_area
from stackloft.geometry.turn_table import cosine_and_sine

NO_CORNERS = np.empty(0, dtype=int)


def blob(count, seed):
    rng = np.random.default_rng(seed)
    t = 2 * np.pi * np.arange(count) / count
    r = 5 + sum(rng.normal(0, 0.4) * np.cos(k * t + rng.uniform(0, 6)) for k in (2, 3, 4))
    return np.column_stack([r * np.cos(t), r * np.sin(t)]) + rng.normal(0, 20, 2)


def test_a_stack_fitted_in_blocks_is_its_loops_fitted_one_by_one():
    loops = [blob(150 + 7 * k, k) for k in range(130)]  # more vertices than are worked on at once
    together = fit_curves(loops, [NO_CORNERS] * len(loops))
    for k, loop in enumerate(loops):
        alone = fit_curves([loop], [NO_CORNERS])
        for name in ("lengths", "areas", "polygon_areas", "centroids", "starts"):
            assert getattr(together, name)[k] == pytest.approx(getattr(alone, name)[0], rel=1e-12, abs=1e-11)
        s = np.linspace(0.0, 1.0, 50)
        assert together.at(np.full(50, k), s)[0] == pytest.approx(alone.at(np.zeros(50, int), s)[0], abs=1e-9)


def test_polygon_areas_are_the_polygons():
    loops = [blob(40, 1), blob(200, 2)]
    curves = fit_curves(loops, [NO_CORNERS, np.array([3, 90])])
    assert curves.polygon_areas == pytest.approx([polygon_area(loop) for loop in loops], rel=1e-13)


def test_loops_with_and_without_corners_do_not_touch_each_other():
    loops = [blob(30, 3), blob(12, 4), blob(31, 5), blob(5, 6)]
    corners = [NO_CORNERS, np.array([9, 2]), NO_CORNERS, np.array([4])]
    first = np.cumsum([0, *map(len, loops)])
    together = segment_tangents(np.concatenate(loops).T, first, corners)
    for k, (loop, marks) in enumerate(zip(loops, corners, strict=True)):
        alone = segment_tangents(np.ascontiguousarray(loop.T), np.array([0, len(loop)]), [marks])
        for one, other in zip(together, alone, strict=True):
            assert one[:, first[k] : first[k + 1]] == pytest.approx(other, abs=1e-11)


def test_angles_by_the_table_are_right_to_rounding():
    turns = np.random.default_rng(0).uniform(0.0, 1.0, 20_000)
    cosine, sine = cosine_and_sine(np.append(turns, [0.0, 0.25, 1.0]))
    angle = 2 * np.pi * np.append(turns, [0.0, 0.25, 1.0])
    assert abs(cosine - np.cos(angle)).max() < 1e-15
    assert abs(sine - np.sin(angle)).max() < 1e-15


def test_shares_and_fractions_are_each_others_inverse_on_every_section():
    rng = np.random.default_rng(1)
    shares = np.cumsum(rng.uniform(0.5, 2.0, (40, 129)), axis=1)
    spread = Spread((shares - shares[:, :1]) / (shares[:, -1:] - shares[:, :1]))
    section, s = np.arange(40)[:, None], rng.uniform(-1.0, 3.0, (40, 17))
    t = spread.share(section, s)
    assert spread.fraction(section, t) == pytest.approx(s, abs=1e-12)
    for k in (0, 39):
        grid = np.linspace(0.0, 1.0, 129)
        expected = np.floor(s[k]) + np.interp(s[k] % 1.0, grid, spread.shares[k])
        assert t[k] == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("lead", [(), (3,), (5, 7)])
def test_patches_integrate_alike_however_they_lie_in_memory(lead):
    patches = np.random.default_rng(2).normal(size=(*lead, 4, 4, 3))
    planes = np.ascontiguousarray(patch_planes(patches))
    back = planes.transpose(*range(planes.ndim - 1, 2, -1), 0, 1, 2)
    assert (back == patches).all()
    assert patch_areas(back) == pytest.approx(patch_areas(patches), rel=1e-13)
    assert patch_areas(patches).shape == lead
    origin = np.array([1.0, -2.0, 0.5])
    assert volume_and_area(back, origin) == pytest.approx(volume_and_area(patches, origin), rel=1e-11)
    assert volume_and_area(patches, origin)[1] == pytest.approx(patch_areas(patches).sum(), rel=1e-12)
    at = np.array([0.0, 0.3, 1.0])
    expected = np.einsum("ai,...ijx,bj->...abx", bernstein(at[:2]), patches, bernstein(at))
    assert evaluate(back, bernstein(at[:2]), bernstein(at)) == pytest.approx(expected, abs=1e-13)


def test_a_grid_is_inside_where_single_rays_cross_oddly():
    loop = blob(300, 7)
    x, y = (np.linspace(low - 1, high + 1, 61) for low, high in zip(loop.min(0), loop.max(0), strict=True))
    start, end = loop, np.roll(loop, -1, axis=0)

    def crossings(px, py):
        over = (start[:, 1] > py) != (end[:, 1] > py)
        a, b = start[over], end[over]
        return int((a[:, 0] + (py - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1]) < px).sum())

    expected = [[crossings(px, py) % 2 == 1 for px in x] for py in y]
    assert inside_grid(x, y, start, end).tolist() == expected
