"""The skin goes through its sections, its integrals are exact, its triangles closed."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stackloft.geometry.bezier_patch import bernstein, evaluate
from stackloft.geometry.creases import find_creases
from stackloft.geometry.joined_tubes import Tube, tessellate_tubes
from stackloft.geometry.loft_rows import RowEnd, closed_rows
from stackloft.geometry.patch_integrals import gauss_unit, solid_integrals
from stackloft.geometry.skin import Rows, section_beziers, skin

FACE = RowEnd(0.0, pole=False)
COLUMNS = 24


def ring(radius, z, count=COLUMNS, ratio=1.0):
    t = 2 * np.pi * np.arange(count) / count
    return np.stack([radius * np.cos(t), ratio * radius * np.sin(t), np.full(count, float(z))], axis=1)


def tube(radii, z):
    return np.stack([ring(r, h) for r, h in zip(radii, z, strict=True)])


def smooth(points):
    return np.zeros(points.shape[:2], dtype=bool)


def closed_edges(faces):
    edges = Counter(
        map(tuple, np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).tolist())
    )
    return all(count == 1 and edges[b, a] == 1 for (a, b), count in edges.items())


def signed_volume(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def test_sections_lie_on_the_skin():
    rng = np.random.default_rng(2)
    points = tube([10, 12, 11, 9, 7], [0, 3, 7, 9, 14]) + rng.normal(0, 0.2, (5, COLUMNS, 3))
    patches = skin(Rows(points, smooth(points), np.zeros(5, bool), (None, None)))
    np.testing.assert_allclose(patches[:, :, 0, 0], points[:-1], atol=1e-12)
    np.testing.assert_allclose(patches[:, :, 3, 0], points[1:], atol=1e-12)
    curves = section_beziers(points, smooth(points))
    np.testing.assert_allclose(patches[:, :, 0], curves[:-1], atol=1e-12)


def test_neighbouring_patches_share_their_edges():
    points = tube([10, 12, 11, 9], [0, 3, 7, 9])
    patches = skin(Rows(points, smooth(points), np.zeros(4, bool), (None, None)))
    np.testing.assert_array_equal(patches[:-1, :, 3], patches[1:, :, 0])
    np.testing.assert_allclose(patches[:, :, :, 3], np.roll(patches, -1, axis=1)[:, :, :, 0], atol=1e-13)


def ball_error(sections):
    height = 2 * 30.0
    z = -30.0 + height * (np.arange(sections) + 0.5) / sections
    points = np.stack([ring(np.sqrt(900 - h * h), h, 96) for h in z])
    end = RowEnd(30.0 - z[-1], pole=True)
    volume, area = solid_integrals(
        skin(closed_rows(points, smooth(points), (end, end))), (None, None), np.eye(4)
    )
    return abs(volume / (4 / 3 * np.pi * 27000) - 1), abs(area / (3600 * np.pi) - 1)


def test_a_ball_converges_at_least_with_third_order():
    errors = np.array([ball_error(m) for m in (6, 12, 24)])
    assert (errors[-1] < 3e-5).all()
    assert (np.log2(errors[0] / errors[2]) / 2 > 2.5).all()


@given(st.floats(0.2, 5.0), st.integers(0, 10_000))
@settings(max_examples=20, deadline=None)
def test_rigid_motion_shear_mirror_and_scale(scale, seed):
    rng = np.random.default_rng(seed)
    points = tube([8, 10, 9, 6], [0, 4, 9, 12])
    patches = skin(closed_rows(points, smooth(points), (FACE, RowEnd(2.0, pole=True))))
    volume, area = solid_integrals(patches, (1.0, None), np.eye(4))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))  # a rotation or a reflection
    affine = np.eye(4)
    affine[:3, :3] = scale * turn
    affine[:3, 3] = rng.uniform(-500, 500, 3)
    moved = solid_integrals(patches, (1.0, None), affine)
    assert moved == pytest.approx((scale**3 * volume, scale**2 * area), rel=1e-11)
    shear = np.eye(4)
    shear[0, 2] = 0.4
    assert solid_integrals(patches, (1.0, None), shear)[0] == pytest.approx(volume, rel=1e-12)


def test_a_prism_is_exact():
    square = np.array([[0.0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]])
    points = np.stack([np.column_stack([square, np.full(8, z)]) for z in (0.0, 1.0, 4.0)]) + [
        50.0,
        60.0,
        70.0,
    ]
    corners = np.zeros((3, 8), bool)
    corners[:, ::2] = True
    patches = skin(closed_rows(points, corners, (FACE, FACE)))
    assert solid_integrals(patches, (1.0, 1.0), np.eye(4)) == pytest.approx((16.0, 40.0), rel=1e-13)


def test_a_cone_with_a_tip_is_exact_up_to_its_circle():
    z = np.array([0.0, 3.0, 6.0, 9.0])
    points = tube(12 - z, z)
    patches = skin(closed_rows(points, smooth(points), (FACE, RowEnd(3.0, pole=True, smooth=False))))
    base = solid_integrals(
        skin(
            closed_rows(
                points[:1].repeat(2, 0) + [[[0, 0, 0]], [[0, 0, 1.0]]], smooth(points[:2]), (FACE, FACE)
            )
        ),
        (True, True),
        np.eye(4),
    )[0]
    assert solid_integrals(patches, (1.0, None), np.eye(4))[0] == pytest.approx(base * 12 / 3, rel=1e-12)


def test_a_flat_end_beyond_continues_the_sides():
    z = np.array([1.0, 3.0, 5.0])
    points = tube(10 - z, z)
    end = RowEnd(1.0, pole=False)
    rows = closed_rows(points, smooth(points), (end, FACE))
    np.testing.assert_allclose(rows.points[0], ring(10.0, 0.0), atol=1e-12)


def test_a_flat_end_far_beyond_is_not_extrapolated_wildly():
    points = tube([2.0, 8.0, 9.0], [0.0, 1.0, 2.0])
    rows = closed_rows(points, smooth(points), (RowEnd(5.0, pole=False), FACE))
    np.testing.assert_allclose(rows.points[0, :, :2], points[0, :, :2])


def test_a_step_does_not_overshoot():
    points = tube([10.0] * 4 + [20.0] * 4, np.arange(8) * 5.0)
    rows = closed_rows(points, smooth(points), (FACE, FACE))
    assert rows.creases.tolist() == [False, False, False, True, True, False, False, False]
    x = bernstein(np.linspace(0, 1, 9))
    surface = evaluate(skin(rows), x, x)
    radius = np.hypot(surface[..., 0], surface[..., 1])
    assert radius.min() > 9.99
    assert radius.max() < 20.01


def test_a_ball_has_no_crease():
    z = np.linspace(-9, 9, 11)
    points = tube(np.sqrt(100 - z**2), z)
    assert not closed_rows(
        points, smooth(points), (RowEnd(1.0, pole=True), RowEnd(1.0, pole=True))
    ).creases.any()
    assert not find_creases(points[:4]).any()


@pytest.mark.parametrize("tolerance", [0.5, 0.05])
@pytest.mark.parametrize("plane", [(True, True), (True, False), (False, False)])
def test_triangles_are_closed_outward_and_near(tolerance, plane):
    points = tube([8, 10, 9, 6], [0, 4, 9, 12])
    ends = tuple(FACE if flat else RowEnd(2.0, pole=True) for flat in plane)
    patches = skin(closed_rows(points, smooth(points), ends))
    closed = tuple(1.0 if flat else None for flat in plane)
    vertices, faces = tessellate_tubes([Tube(patches, closed)], [], tolerance)
    volume, area = solid_integrals(patches, closed, np.eye(4))
    assert closed_edges(faces)
    assert abs(signed_volume(vertices, faces) - volume) < tolerance * area
    assert signed_volume(vertices, faces) > 0.0


def test_a_face_with_points_in_line_stays_closed():
    side = np.linspace(0, 1, 9)[:-1]
    square = np.concatenate(
        [
            np.stack(p, 1)
            for p in ((side, 0 * side), (0 * side + 1, side), (1 - side, 0 * side + 1), (0 * side, 1 - side))
        ]
    )
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    points = np.stack([np.column_stack([square @ turn.T, np.full(32, z)]) for z in (0.0, 1.0)])
    corners = np.zeros((2, 32), bool)
    corners[:, ::8] = True
    patches = skin(closed_rows(points, corners, (FACE, FACE)))
    _, faces = tessellate_tubes([Tube(patches, (1.0, 1.0))], [], 0.01)
    assert closed_edges(faces)


@pytest.mark.parametrize("degree", range(1, 12))
def test_gauss_integrates_every_monomial_to_its_degree(degree):
    x, w = gauss_unit(degree)
    for power in range(degree + 1):
        assert w @ x**power == pytest.approx(1 / (power + 1), rel=1e-13)
