"""STL and PLY read back by meshio equal what was written."""

import io

import meshio
import numpy as np
import pytest

from stackloft.model.errors import OutputError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.writers.ply import PlyWriter
from stackloft_plugins.writers.stl import StlWriter


def octahedron(scale=1.0, origin=(0.0, 0.0, 0.0)):
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return TriMesh(vertices * scale + np.array(origin), np.array(faces))


def signed_volume(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def read_back(writer, product, tmp_path):
    path = tmp_path / f"solid{writer.suffixes[0]}"
    with path.open("wb") as stream:
        writer.write(product, stream)
    return meshio.read(path)


def test_ply_keeps_every_vertex_bit_and_every_face(tmp_path):
    mesh = octahedron(scale=np.pi, origin=(1234.5678901234, -0.1, 1e-9))
    back = read_back(PlyWriter(), mesh, tmp_path)
    assert np.array_equal(back.points, mesh.vertices)
    assert np.array_equal(back.cells_dict["triangle"], mesh.faces)


def test_stl_keeps_every_corner_to_single_precision_and_its_orientation(tmp_path):
    mesh = octahedron(scale=37.3, origin=(5.5, -17.25, 101.0))
    back = read_back(StlWriter(), mesh, tmp_path)
    corners = back.points[back.cells_dict["triangle"]]
    assert np.array_equal(corners, mesh.vertices[mesh.faces].astype(np.float32))
    assert signed_volume(back.points.astype(float), back.cells_dict["triangle"]) == pytest.approx(
        4 / 3 * 37.3**3, rel=1e-5
    )


def test_stl_normals_point_outward_with_unit_length():
    mesh = octahedron()
    stream = io.BytesIO()
    StlWriter().write(mesh, stream)
    raw = stream.getvalue()
    assert len(raw) == 84 + 50 * len(mesh.faces)
    assert int.from_bytes(raw[80:84], "little") == len(mesh.faces)
    assert not raw.startswith(b"solid"), "an ASCII reader would take it for text"
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows = np.frombuffer(raw[84:], dtype=record)
    outward = np.einsum("ij,ij->i", rows["normal"], rows["corners"].mean(axis=1))
    assert (outward > 0).all()
    assert np.allclose(np.linalg.norm(rows["normal"], axis=1), 1)


def test_stl_of_a_triangle_without_area_has_a_zero_normal():
    flat = TriMesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]]))
    stream = io.BytesIO()
    StlWriter().write(flat, stream)
    assert np.array_equal(np.frombuffer(stream.getvalue()[84:96], "<f4"), np.zeros(3))


@pytest.mark.parametrize("writer", [StlWriter(), PlyWriter()], ids=["stl", "ply"])
@pytest.mark.parametrize(
    ("vertices", "faces", "what"),
    [
        (np.eye(3), np.zeros((0, 3), dtype=int), "no triangles"),
        (np.full((3, 3), np.nan), np.array([[0, 1, 2]]), "not finite"),
        (np.eye(3), np.array([[0, 1, 3]]), "does not exist"),
        (np.eye(3), np.array([[0, 1, -1]]), "does not exist"),
    ],
)
def test_a_surface_that_is_none_is_refused_before_a_byte_is_written(writer, vertices, faces, what):
    stream = io.BytesIO()
    with pytest.raises(OutputError, match=what):
        writer.write(TriMesh(vertices, faces), stream)
    assert stream.getvalue() == b""


@pytest.mark.parametrize("writer", [StlWriter(tolerance=0.5), PlyWriter(tolerance=0.5)], ids=["stl", "ply"])
def test_a_solid_is_tessellated_to_the_writers_own_tolerance(writer, monkeypatch):
    asked = []

    def tessellate(self, tolerance):
        asked.append(tolerance)
        return octahedron()

    monkeypatch.setattr(LoftedSolid, "tessellate", tessellate)
    writer.write(LoftedSolid(shells=()), io.BytesIO())
    assert asked == [0.5]
