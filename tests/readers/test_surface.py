"""Triangle surfaces from STL, PLY and OBJ: what was written is what is read; what is damaged is said so."""

import random
import re

import meshio
import numpy as np
import pytest
import pyvista
from typer.testing import CliRunner

import stackloft
from stackloft.cli.app import app
from stackloft.geometry.closed_mesh import mesh_integrals, unmatched_edges
from stackloft.model.errors import InputError, StackloftError
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.readers.surface import SurfaceReader
from stackloft_plugins.writers.ply import PlyWriter
from stackloft_plugins.writers.stl import StlWriter

CORNERS = np.array([[x, y, z] for x in (-2.5, 2.0) for y in (0.0, 3.0) for z in (101.0, 105.5)])
QUADS = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
BOX = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))])
HUGE = b"ply\nformat %s 1.0\nelement vertex 4000000000\nproperty double x\nend_header\n"
VOLUME, AREA = 4.5 * 3.0 * 4.5, 2 * (4.5 * 3.0 + 3.0 * 4.5 + 4.5 * 4.5)


def obj_text(quads=QUADS + 1, vertices=CORNERS):
    lines = ["# a box", "mtllib none.mtl", "o box"]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += ["vt 0 0", "vn 0 0 1", "usemtl grey", "s off"]
    return "\n".join([*lines, *("f " + " ".join(map(str, quad)) for quad in quads)]) + "\n"


def by_stackloft(writer):
    def write(name):
        with name.open("wb") as stream:
            writer.write(TriMesh(CORNERS, BOX), stream)

    return write


def by_meshio(module, *, binary):
    return lambda name: module.write(name, meshio.Mesh(CORNERS, [("triangle", BOX)]), binary=binary)


def by_pyvista(*, triangles=True, binary=True):
    def write(name):
        surface = pyvista.PolyData(CORNERS, np.column_stack([np.full(6, 4), QUADS]).ravel())
        surface = surface.triangulate() if triangles else surface
        surface.save(name, **({} if name.suffix == ".obj" else {"binary": binary}))

    return write


def binary_that_begins_with_solid(name):
    by_meshio(meshio.stl, binary=True)(name)
    name.write_bytes(b"solid " + name.read_bytes()[6:])


def big_endian_of_two_lengths(name):
    header = "ply\nformat binary_big_endian 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
    header += "property float z\nproperty uchar red\nelement face 9\n"
    header += "property list uchar int vertex_index\nproperty short flags\nend_header\n"
    content = b"".join(corner.astype(">f4").tobytes() + b"\x07" for corner in CORNERS)
    for face in [*QUADS[:3], *BOX[6:]]:
        content += bytes([len(face)]) + face.astype(">i4").tobytes() + b"\0\1"
    name.write_bytes(header.encode() + content)


def as_obj(*arguments):
    return lambda name: name.write_text(obj_text(*arguments))


WRITTEN = {
    "stl-own": by_stackloft(StlWriter()),
    "stl-text": by_meshio(meshio.stl, binary=False),
    "stl-binary": by_meshio(meshio.stl, binary=True),
    "stl-solid": binary_that_begins_with_solid,
    "stl-pyvista": by_pyvista(),
    "ply-own": by_stackloft(PlyWriter()),
    "ply-text": by_meshio(meshio.ply, binary=False),
    "ply-quads": by_pyvista(triangles=False),
    "ply-quads-text": by_pyvista(triangles=False, binary=False),
    "ply-big": big_endian_of_two_lengths,
    "ply-pyvista": by_pyvista(),
    "obj": as_obj(),
    "obj-backwards": as_obj(QUADS - 8),
    "obj-slashes": as_obj([[f"{k}/1/1" for k in quad] for quad in QUADS + 1]),
    "obj-seams": as_obj(np.arange(24).reshape(6, 4) + 1, CORNERS[QUADS].reshape(-1, 3)),
    "obj-pyvista": by_pyvista(),
}
"""Ways in which a person may have the box."""
WAYS = tuple(WRITTEN)


def written(how, folder):
    path = folder / f"box.{how[:3]}"
    WRITTEN[how](path)
    return path


@pytest.mark.parametrize("how", WAYS)
def test_a_box_is_a_box_whoever_wrote_it(how, tmp_path):
    path = written(how, tmp_path)
    assert SurfaceReader().probe(path) > 0.5
    mesh = SurfaceReader().read(path)
    assert unmatched_edges(mesh.faces) == 0
    assert len(np.unique(mesh.vertices, axis=0)) == 8
    assert mesh_integrals(mesh.vertices, mesh.faces) == pytest.approx((VOLUME, AREA), rel=1e-6)
    assert [notice.code for notice in mesh.notices] == ([] if "own" in how else ["unit-assumed"])


def test_a_unit_that_is_told_counts(tmp_path):
    mesh = SurfaceReader(unit="in").read(written("obj", tmp_path))
    assert mesh_integrals(mesh.vertices, mesh.faces)[0] == pytest.approx(VOLUME * 25.4**3, rel=1e-12)
    assert not mesh.notices


def test_it_is_measured_without_naming_reader_or_method(tmp_path):
    result = stackloft.measure(written("ply-own", tmp_path))
    assert result.source["reader"] == "surface"
    body = result.objects[0]
    assert body.volume.method == "polyhedral"
    assert (body.volume.value, body.area.value) == pytest.approx((VOLUME, AREA), rel=1e-12)
    in_cm = stackloft.measure(written("obj", tmp_path), unit="cm")
    assert in_cm.objects[0].volume.value == pytest.approx(VOLUME * 1000)
    assert in_cm.recipe["method"] == "polyhedral"


def test_an_l_shaped_face_is_cut_in_its_plane(tmp_path):
    outline = np.array([(0, 0), (4, 0), (4, 1), (1, 1), (1, 3), (0, 3)], dtype=float)
    low, high = (np.column_stack([outline, np.full(6, z)]) for z in (0.0, 2.0))
    sides = [(k + 1, (k + 1) % 6 + 1, (k + 1) % 6 + 7, k + 7) for k in range(6)]
    path = tmp_path / "l.obj"
    path.write_text(obj_text([[6, 5, 4, 3, 2, 1], [10, 11, 12, 7, 8, 9], *sides], np.vstack([low, high])))
    mesh = SurfaceReader().read(path)
    assert mesh_integrals(mesh.vertices, mesh.faces) == pytest.approx((12.0, 2 * 6 + 14 * 2), rel=1e-12)


@pytest.mark.parametrize("drop", [0, 5, 11])
def test_an_open_surface_is_refused_when_measured_with_the_way_to_mend_it(drop, tmp_path):
    path = tmp_path / "open.ply"
    meshio.ply.write(path, meshio.Mesh(CORNERS, [("triangle", np.delete(BOX, drop, axis=0))]))
    with pytest.raises(InputError, match=r"open.*3 edges that belong to one triangle alone.*--method repair"):
        stackloft.measure(path)


def test_a_triangle_turned_over_or_one_too_many_is_refused(tmp_path):
    for faces, told in (
        (np.vstack([BOX[:1, ::-1], BOX[1:]]), "do not agree on which side is out"),
        (np.vstack([BOX, BOX[:1]]), "three triangles or more"),
    ):
        path = tmp_path / "odd.ply"
        meshio.ply.write(path, meshio.Mesh(CORNERS, [("triangle", faces)]))
        with pytest.raises(InputError, match=told):
            stackloft.measure(path)


@pytest.mark.parametrize("how", WAYS)
def test_damaged_files_end_in_one_line_or_in_a_surface(how, tmp_path):
    """Cut off and bytes changed: never another exception, never a surface with vertices that do not exist."""
    whole = written(how, tmp_path).read_bytes()
    rng = random.Random(how)
    path = tmp_path / f"damaged.{how[:3]}"
    for round_ in range(60):
        content = bytearray(whole)
        if round_ % 2:
            content = content[: rng.randrange(len(content))]
        for _ in range(rng.randrange(1, 6) if round_ % 3 else 0):
            if content:
                content[rng.randrange(len(content))] = rng.randrange(256)
        path.write_bytes(content)
        probed = SurfaceReader().probe(path)
        assert 0.0 <= probed <= 1.0
        mesh, said = outcome(path)
        if mesh is None:
            assert str(path) in said
            assert "\n" not in said
        else:
            assert np.isfinite(mesh.vertices).all()
            assert mesh.faces.min() >= 0
            assert mesh.faces.max() < len(mesh.vertices)


def outcome(path):
    try:
        return SurfaceReader().read(path), ""
    except InputError as error:
        return None, str(error)


@pytest.mark.parametrize("how", WAYS)
def test_half_a_file_is_never_measured(how, tmp_path):
    whole = written(how, tmp_path).read_bytes()
    path = tmp_path / f"half.{how[:3]}"
    for part in (0.1, 0.5, 0.8, 0.97):
        path.write_bytes(whole[: int(part * len(whole))])
        with pytest.raises(StackloftError):
            stackloft.measure(path)


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        ("a.stl", b"", "nothing to read|is empty"),
        ("a.stl", b"solid nothing\nendsolid\n", "has no triangle"),
        ("a.stl", bytes(80) + b"\x09\0\0\0" + bytes(120), "9 triangles are announced, 2 are there"),
        ("a.stl", bytes(80) + b"\x01\0\0\0" + np.full(12, np.nan, "<f4").tobytes() + b"\0\0", "not finite"),
        ("a.ply", HUGE % b"ascii", "cut off"),
        ("a.ply", HUGE % b"binary_little_endian", "cut off"),
        ("a.ply", b"ply\nformat ascii 2.0 x\nend_header\n", "has no triangle"),
        ("a.ply", b"ply\nformat middle_endian 1.0\nend_header\n", "another format"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "names a vertex that does not exist; there are 3"),
        ("a.obj", b"v 0 0 0\nv 1 0 zero\n", "line 2 cannot be read"),
        ("a.obj", b"v 0 0 0\nf 0 1 1\n", "line 2 cannot be read"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nf 1 2\n", "fewer than three corners"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(name, content, told, tmp_path):
    path = tmp_path / name
    path.write_bytes(content)
    run = CliRunner().invoke(app, ["measure", str(path)])
    assert run.exit_code == 1
    line = run.stderr
    assert line.count("\n") == 1
    assert re.search(told, line), line
    assert str(path) in line


def test_info_and_measure_on_the_command_line(tmp_path):
    path = written("stl-text", tmp_path)
    run = CliRunner().invoke(app, ["info", str(path)])
    assert "12 triangles, 8 vertices" in run.stdout
    run = CliRunner().invoke(app, ["measure", str(path), "--quiet", "--units", "mm"])
    assert run.exit_code == 0
    assert "unit-assumed" in run.stderr
    assert "60.75" in run.stdout


def test_a_missing_file_and_a_folder_are_not_claimed(tmp_path):
    assert SurfaceReader().probe(tmp_path) == 0
    assert SurfaceReader().probe(tmp_path / "gone.stl") == 0
    with pytest.raises(InputError, match="does not exist"):
        SurfaceReader().read(tmp_path / "gone.stl")
