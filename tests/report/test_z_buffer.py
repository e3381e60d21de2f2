"""What is drawn of a surface is what an eye would see of it."""

import io

import numpy as np
import pytest
from PIL import Image

from stackloft.model.tri_mesh import TriMesh
from stackloft.report.views import FILL, SIDE, VIEWS, _right_handed, write_views
from stackloft.report.z_buffer import draw_triangles


def ball(radius=1.0, rows=40, columns=64):
    """Return vertices and outward triangles of a ball."""
    u, v = np.meshgrid(np.arange(columns) * 2 * np.pi / columns, np.linspace(0, np.pi, rows + 1)[1:-1])
    ring = np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)], axis=2).reshape(-1, 3)
    points = radius * np.concatenate([ring, [[0, 0, 1.0], [0, 0, -1.0]]])
    number = np.arange((rows - 1) * columns).reshape(rows - 1, columns)
    right = np.roll(number, -1, axis=1)
    a, b, c, d = number[:-1], right[:-1], right[1:], number[1:]
    sides = [np.stack([a, d, c], axis=2).reshape(-1, 3), np.stack([a, c, b], axis=2).reshape(-1, 3)]
    top = np.stack([np.full(columns, len(ring)), number[0], right[0]], axis=1)
    foot = np.stack([np.full(columns, len(ring) + 1), right[-1], number[-1]], axis=1)
    return points, np.concatenate([*sides, top, foot])


def box(sides):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * np.array(sides, float)
    squares = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in squares for face in ((a, b, c), (a, c, d))]
    return corners, np.array(faces)


def test_a_ball_covers_its_disc_and_shows_its_own_normals():
    points, faces = ball(80.0)
    drawn = draw_triangles(points + [100.0, 100.0, 0.0], faces, (200, 200))
    assert drawn.seen.sum() == pytest.approx(np.pi * 80**2, rel=4e-3)
    rows, columns = np.nonzero(drawn.seen)
    x, y = (columns + 0.5 - 100) / 80, (rows + 0.5 - 100) / 80
    inner = x**2 + y**2 < 0.9
    true = np.stack([x, y, -np.sqrt(np.clip(1 - x**2 - y**2, 0, 1))], axis=1)
    assert np.abs(drawn.normals[rows, columns] - true)[inner].max() < 0.03
    assert np.abs(drawn.depth[rows, columns] / 80 - true[:, 2])[inner].max() < 0.01


def test_the_nearer_of_two_bodies_is_seen():
    near, faces = box((20, 20, 5))
    far = near * np.array([2, 2, 1]) + [0, 0, 50]
    drawn = draw_triangles(np.concatenate([near, far]), np.concatenate([faces, faces + 8]), (48, 48))
    assert drawn.depth[10, 10] == 0.0
    assert drawn.depth[30, 30] == 50.0
    assert drawn.seen.sum() == 40 * 40


def test_plane_faces_are_flat_up_to_their_edges():
    points, faces = box((30, 30, 30))
    turn = _right_handed(VIEWS["from a corner"])
    drawn = draw_triangles((points - 15) @ turn.T + 32, faces, (64, 64))
    found = np.unique(drawn.normals[drawn.seen].round(4), axis=0)
    assert len(found) == 3
    assert np.allclose(np.abs(found @ turn).max(axis=1), 1.0, atol=1e-3)


def test_large_triangles_are_whole():
    points, faces = box((1900.0, 900.0, 10.0))
    drawn = draw_triangles(points, faces, (2000, 1000))
    assert drawn.seen.sum() == 1900 * 900


def test_what_reaches_beyond_the_picture_is_cut_off():
    points, faces = ball(80.0)
    drawn = draw_triangles(points, faces, (50, 50))
    assert drawn.seen.all()


@pytest.mark.parametrize("view", VIEWS)
def test_no_view_is_mirrored(view):
    turn = _right_handed(VIEWS[view])
    assert np.linalg.det(turn) == pytest.approx(1.0)
    assert np.abs(turn - VIEWS[view]).max() < 0.1


def views(mesh, lines=()):
    stream = io.BytesIO()
    write_views(mesh, lines, stream)
    return np.asarray(Image.open(stream).convert("RGB")).astype(float)


def test_the_sheet_shows_each_side_at_one_scale():
    points, faces = box((40, 20, 10))
    sheet = views(TriMesh(points - 7, faces))
    shown = np.ptp(sheet, axis=2) > 20  # clay is coloured, paper and ink are not
    first, second = shown[14 : 14 + SIDE, 14 : 14 + SIDE], shown[14 : 14 + SIDE, 28 + SIDE : 28 + 2 * SIDE]
    turn = _right_handed(VIEWS["from a corner"])
    per_mm = FILL * SIDE / max(40.0, np.ptp(points @ turn.T, axis=0)[:2].max())
    for part, sides in ((first, (40, 20)), (second, (10, 20))):
        rows, columns = np.nonzero(part)
        assert np.ptp(columns) + 1 == pytest.approx(sides[0] * per_mm, abs=3)
        assert np.ptp(rows) + 1 == pytest.approx(sides[1] * per_mm, abs=3)


def test_sections_are_lines_where_they_are_not_hidden():
    points, faces = ball(20.0)
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    line = 20.02 * np.column_stack([np.cos(angle), np.sin(angle) * 0.6, np.sin(angle) * 0.8])
    plain, lined = views(TriMesh(points, faces)), views(TriMesh(points, faces), [line])
    at = np.argwhere((plain != lined).any(axis=2)[14 : 14 + SIDE, 14 : 14 + SIDE])
    per_mm = FILL * SIDE / 40
    place = line[:, 1::-1] * per_mm + SIDE / 2
    away = np.linalg.norm(at[:, None] + 0.5 - place[None], axis=2)
    assert away[:, line[:, 2] < -3.0].min(axis=0).max() < 2.0
    assert away[:, line[:, 2] < 2.0].min(axis=1).max() < 3.0
