"""Points find their feet on patches and curves: to rounding, at poles too, across patches."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from stackloft.geometry.bezier_patch import bernstein
from stackloft.geometry.exact_curves import CurveSet
from stackloft.geometry.exact_surface import ExactSurface, points_on
from stackloft.geometry.raised_tets import raised
from stackloft.geometry.relaxed_tets import relaxed
from stackloft.geometry.sharp_lines import sharp_columns, sharp_rows
from stackloft.geometry.tet_jacobian import jacobian_bounds
from stackloft.testing import phantoms
from stackloft.testing.conformance.ellipsoids import lofted_solid
from stackloft_plugins.reconstructors.loft import LoftReconstructor


@pytest.fixture(scope="module")
def surface():
    return ExactSurface(lofted_solid(4).shells[0].patches)


def feet_and_normals(surface, count):
    rng = np.random.default_rng(0)
    which = rng.integers(0, len(surface.patches), count)
    v, u = 0.01 + 0.98 * rng.random((2, count))
    points = points_on(surface.patches, which, v, u)
    step = 1e-5
    along = points_on(surface.patches, which, v, u + step) - points_on(surface.patches, which, v, u - step)
    up = points_on(surface.patches, which, v + step, u) - points_on(surface.patches, which, v - step, u)
    normals = np.cross(along, up)
    return points, normals / np.linalg.norm(normals, axis=1)[:, None]


@pytest.mark.parametrize("off", [0.0, 0.01, 0.3, -0.5])
def test_a_point_off_the_surface_finds_its_foot(surface, off):
    points, normals = feet_and_normals(surface, 1000)
    found = surface.project(points + off * normals)
    assert np.abs(found.distance - abs(off)).max() < 1e-7
    assert np.linalg.norm(found.points - points, axis=1).max() < 1e-3 * abs(off) + 1e-9
    on = points_on(surface.patches, found.patch, *found.at.T)
    np.testing.assert_array_equal(found.points, on)


def test_poles_are_met_from_every_side(surface):
    pole = surface.patches[0, 0, 0]
    points = pole + np.random.default_rng(3).normal(0.0, 0.2, (500, 3))
    even = bernstein(np.linspace(0, 1, 80))
    dense = np.einsum("ak,nkld,bl->nabd", even, surface.patches[:32], even).reshape(-1, 3)
    found = surface.project(points)
    assert (found.distance <= cKDTree(dense).query(points)[0] + 1e-9).all()
    assert surface.project(pole[None]).distance[0] < 1e-9


def test_a_foot_goes_on_through_neighbours_however_it_is_started(surface):
    points, _ = feet_and_normals(surface, 300)
    assert surface.project(points, starts=1).distance.max() < 1e-9


def test_curves():
    line = np.linspace([0.0, 0.0, 0.0], [3.0, 0.0, 0.0], 4)
    curves = CurveSet(np.stack([line, line + [3.0, 0.0, 0.0]]))
    found = curves.project(np.array([[1.2, 4.0, 0.0], [5.0, 0.0, 1.0], [9.0, 0.0, 0.0]]))
    np.testing.assert_allclose(found.points, [[1.2, 0, 0], [5, 0, 0], [6, 0, 0]], atol=1e-9)
    assert found.patch.tolist() == [0, 1, 1]


def test_sharp_lines_are_those_of_corners_and_creases():
    box = LoftReconstructor(ends="face").reconstruct(
        phantoms.make("box").contour_stack(sections=3, placing="faces")
    )
    patches = box.shells[0].patches
    assert sharp_columns(patches).sum() == 4
    assert sharp_rows(patches).tolist() == [True, False, True]
    smooth = lofted_solid(4).shells[0].patches
    assert sharp_columns(smooth).sum() == 0
    assert sharp_rows(smooth).sum() == 2


@pytest.mark.parametrize("order", [2, 3])
def test_inner_nodes_make_way_for_a_boundary_that_bulges_in(order):
    # a flat brick whose upper side is pushed down to near its lower one, much further than its nodes' spacing
    side = np.linspace(0, 3, 4)
    grid = np.array([[x, y, z] for z in (0.0, 0.5, 1.0) for y in side for x in side])
    index = np.arange(48).reshape(3, 4, 4)
    cubes = np.stack(
        [index[k : k + 2, j : j + 2, i : i + 2].ravel() for k in range(2) for j in range(3) for i in range(3)]
    )
    six = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]])
    elements = cubes[:, six].reshape(-1, 4)
    high = raised(elements, 48, order)
    straight = high.straight(grid)
    low, top = np.isclose(straight[:, 2], 0.0), np.isclose(straight[:, 2], 1.0)
    wall = np.isclose(straight[:, 0] % 3, 0.0) | np.isclose(straight[:, 1] % 3, 0.0)
    held = low | top | wall
    placed = straight.copy()
    x, y = straight[top, 0], straight[top, 1]
    placed[top, 2] -= 0.7 * np.sin(np.pi * x / 3) * np.sin(np.pi * y / 3)
    assert (jacobian_bounds(placed[high.elements]).low <= 0).any()
    found = relaxed(straight, placed, high.elements, held)
    assert (jacobian_bounds(found[high.elements]).low > 0).all()
    np.testing.assert_array_equal(found[held], placed[held])


def test_what_is_valid_is_left_alone():
    nodes = np.vstack([np.zeros(3), np.eye(3)])
    high = raised(np.array([[0, 1, 2, 3]]), 4, 2)
    straight = high.straight(nodes)
    assert relaxed(straight, straight, high.elements, np.ones(10, bool)) is straight


def test_edge_and_face_nodes_are_shared_whichever_way_an_element_runs_them():
    elements = np.array([[0, 1, 2, 3], [2, 1, 4, 3]])
    nodes = np.random.default_rng(5).random((5, 3))
    for order in (2, 3):
        high = raised(elements, 5, order)
        straight = high.straight(nodes)
        from stackloft.geometry.lagrange_simplex import tet_lattice  # noqa: PLC0415

        for element, row in zip(elements, high.elements, strict=True):
            np.testing.assert_allclose(straight[row], tet_lattice(order) @ nodes[element] / order, atol=1e-14)
        shared = {2: 6, 3: 3 + 6 + 1}[order]
        assert len(straight) == 2 * high.elements.shape[1] - shared
