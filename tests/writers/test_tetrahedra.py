"""Tetrahedra read back by independent readers: the same nodes, volume, area and groups, order 1 and 2."""

import io
from dataclasses import replace

import meshio
import numpy as np
import pytest
import pyvista

from stackloft.geometry.lagrange_simplex import TET_NODES, TRIANGLE_NODES
from stackloft.geometry.tet_integrals import elements_volume, faces_area
from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.errors import OutputError
from stackloft.model.tet_mesh import TetMesh
from stackloft.testing.conformance.ellipsoids import tet_mesh
from stackloft_plugins.conformance import read_mphtxt
from stackloft_plugins.writers.inp import InpWriter
from stackloft_plugins.writers.mphtxt import MphtxtWriter
from stackloft_plugins.writers.msh import MshWriter
from stackloft_plugins.writers.vtu import VtuWriter

WRITERS = {"vtu": VtuWriter(), "msh": MshWriter(), "inp": InpWriter(), "mphtxt": MphtxtWriter()}
TET, TRIANGLE = {1: "tetra", 2: "tetra10"}, {1: "triangle", 2: "triangle6"}


def mesh_of(order):
    """The kit's ellipsoid; at order 1 its vertices alone."""
    curved = tet_mesh(1)
    if order == 2:
        return curved
    used, index = np.unique(curved.elements[:, :4], return_inverse=True)
    place = np.zeros(len(curved.nodes), dtype=int)
    place[used] = np.arange(len(used))
    return replace(
        curved,
        nodes=frozen_floats(curved.nodes[used]),
        elements=frozen_ints(index.reshape(-1, 4)),
        faces=frozen_ints(place[curved.faces[:, :3]]),
    )


def written(name, mesh, tmp_path):
    path = tmp_path / f"mesh.{name}"
    with path.open("wb") as stream:
        WRITERS[name].write(mesh, stream)
    return path


def figures(nodes, elements, faces):
    return elements_volume(nodes, elements, 4), faces_area(nodes, faces, 10)


def same(mesh, nodes, elements, faces):
    assert figures(nodes, elements, faces) == pytest.approx(
        figures(mesh.nodes, mesh.elements, mesh.faces), rel=1e-12
    )


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("name", ["vtu", "msh", "inp"])
def test_meshio_reads_the_same_nodes_volume_and_area(name, order, tmp_path):
    mesh = mesh_of(order)
    back = meshio.read(written(name, mesh, tmp_path))
    assert np.array_equal(back.points, mesh.nodes), "to the bit"
    elements = back.cells_dict[TET[order]]
    assert np.array_equal(elements, mesh.elements)
    faces = back.cells_dict.get(TRIANGLE[order], mesh.faces)
    assert len(faces) == len(mesh.faces)
    same(mesh, back.points, elements, faces)


def test_vtu_names_its_groups_for_pyvista(tmp_path):
    for order in (1, 2):
        mesh = mesh_of(order)
        grid = pyvista.read(written("vtu", mesh, tmp_path))
        number = {key.removeprefix("group "): int(grid.field_data[key][0]) for key in grid.field_data}
        assert number == {"body": 0, "side": 1, "first-face": 2}
        group, kind = grid.cell_data["group"], {1: 5, 2: 22}[order]
        assert np.count_nonzero(group == 0) == len(mesh.elements)
        for name in mesh.group_names:
            cells = grid.cells_dict[kind][group[grid.celltypes == kind] == number[name]]
            assert np.array_equal(cells, mesh.faces_of(name))
        first = grid.extract_cells(group == 0).compute_cell_sizes(length=False, area=False)
        if order == 1:
            whole = figures(mesh.nodes, mesh.elements, mesh.faces)[0]
            assert first.cell_data["Volume"].sum() == pytest.approx(whole, rel=1e-9)


def test_vtu_holds_order_3(tmp_path):
    corner = np.vstack([np.zeros(3), np.eye(3)])
    from stackloft.geometry.raised_tets import raised  # noqa: PLC0415
    from stackloft.geometry.tet_boundary import boundary_faces  # noqa: PLC0415

    high = raised(np.array([[0, 1, 2, 3]]), 4, 3)
    mesh = TetMesh(
        frozen_floats(high.straight(corner)),
        frozen_ints(high.elements),
        frozen_ints(boundary_faces(high.elements)),
    )
    grid = pyvista.read(written("vtu", mesh, tmp_path))
    assert set(grid.celltypes.tolist()) == {71, 69}
    assert {71: TET_NODES[3], 69: TRIANGLE_NODES[3]} == {71: 20, 69: 10}
    assert grid.extract_cells([0]).compute_cell_sizes().cell_data["Volume"].sum() == pytest.approx(1 / 6)
    for name in ("msh", "inp", "mphtxt"):
        with pytest.raises(OutputError, match=r"order 3; expected: order 2 or less; fix: give --order 2"):
            WRITERS[name].write(mesh, io.BytesIO())


def test_msh_names_its_groups_for_meshio(tmp_path):
    mesh = mesh_of(2)
    back = meshio.read(written("msh", mesh, tmp_path))
    assert {name: tuple(data) for name, data in back.field_data.items()} == {
        "side": (1, 2),
        "first-face": (2, 2),
        "body": (1, 3),
    }
    tags = np.concatenate([data for data in back.cell_data["gmsh:physical"] if len(data)])
    assert np.bincount(tags[: len(mesh.faces)]).tolist() == [0, len(mesh.faces) // 2, len(mesh.faces) // 2]


@pytest.fixture(scope="module")
def gmsh():
    try:
        import gmsh as module  # noqa: PLC0415
    except (ImportError, OSError) as error:
        pytest.skip(f"gmsh cannot be imported: {error}")
    module.initialize(["gmsh", "-nopopup"], interruptible=False)
    module.option.setNumber("General.Terminal", 0)
    yield module
    module.finalize()


@pytest.mark.parametrize("order", [1, 2])
def test_gmsh_reads_volume_area_and_groups(gmsh, order, tmp_path):
    mesh = mesh_of(order)
    gmsh.open(str(written("msh", mesh, tmp_path)))
    names = {gmsh.model.getPhysicalName(*pair): pair for pair in gmsh.model.getPhysicalGroups()}
    assert set(names) == {"side", "first-face", "body"}
    found = {name: integral(gmsh, *pair) for name, pair in names.items()}
    volume, area = figures(mesh.nodes, mesh.elements, mesh.faces)
    assert found["body"] == pytest.approx(volume, rel=1e-9)
    assert found["side"] + found["first-face"] == pytest.approx(area, rel=1e-6)
    lower = faces_area(mesh.nodes, mesh.faces_of("first-face"), 10)
    assert found["first-face"] == pytest.approx(lower, rel=1e-6)


def integral(gmsh, dimension, tag):
    """Gmsh's own integral of 1 over a physical group."""
    total = 0.0
    for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
        for kind in gmsh.model.mesh.getElementTypes(dimension, int(entity)):
            points, weights = gmsh.model.mesh.getIntegrationPoints(kind, "Gauss10")
            jacobians = gmsh.model.mesh.getJacobians(kind, points, int(entity))[1]
            total += float((jacobians.reshape(-1, len(weights)) @ weights).sum())
    return total


@pytest.mark.parametrize("order", [1, 2])
def test_inp_sets_and_surfaces_are_the_groups(order, tmp_path):
    mesh = mesh_of(order)
    path = written("inp", mesh, tmp_path)
    sets = meshio.read(path).point_sets
    for name in mesh.group_names:
        wanted = np.unique(mesh.faces_of(name))
        assert np.array_equal(np.sort(sets[name.upper().replace("-", "_")]), wanted)
    sides = {"S1": (0, 1, 2), "S2": (0, 3, 1), "S3": (1, 3, 2), "S4": (2, 3, 0)}
    lines = path.read_text().split("*SURFACE, NAME=S_FIRST_FACE, TYPE=ELEMENT\n")[1].splitlines()
    rows = [line.split(", ") for line in lines if not line.startswith("*")]
    found = {frozenset(mesh.elements[int(k) - 1][list(sides[side])].tolist()) for k, side in rows}
    assert found == {frozenset(face) for face in mesh.faces_of("first-face")[:, :3].tolist()}


def test_mphtxt_has_the_same_mesh_and_its_groups_as_selections(tmp_path):
    mesh = mesh_of(2)
    path = written("mphtxt", mesh, tmp_path)
    back = read_mphtxt(path)
    assert np.array_equal(back.nodes, mesh.nodes)
    same(mesh, back.nodes, back.elements, back.faces)
    text = path.read_text()
    for name, dimension, entity in (("side", 2, 0), ("first-face", 2, 1), ("body", 3, 1)):
        label = f"{len(name)} {name} # Label\n5 mesh1 # Geometry/mesh tag\n{dimension} # Dimension\n"
        assert f"{label}1 # Number of entities\n# Entities\n{entity}\n" in text
    assert "4 tet2 # type name" in text
    assert "3 tet # type name" in written("mphtxt", mesh_of(1), tmp_path).read_text()


@pytest.mark.parametrize("name", WRITERS)
def test_a_mesh_that_is_not_whole_is_not_written(name):
    mesh = mesh_of(1)
    turned = replace(mesh, elements=frozen_ints(mesh.elements[:, [0, 2, 1, 3]]))
    for broken in (turned, replace(mesh, faces=frozen_ints(mesh.faces[:-1]), groups=mesh.groups[:-1])):
        stream = io.BytesIO()
        with pytest.raises(OutputError, match="cannot be written"):
            WRITERS[name].write(broken, stream)
        assert not stream.getvalue()


@pytest.mark.prove
def test_mphtxt_is_read_by_another_s_reader(tmp_path, proof):
    """Fealpy's reader, when it is installed; second-order nodes in the order that FEconv publishes."""
    reader = pytest.importorskip("fealpy.old.mesh.mphtxt_file_reader").MPHTxtFileReader
    rows = []
    for order, (tri, tet) in {1: ("tri", "tet"), 2: ("tri2", "tet2")}.items():
        mesh = mesh_of(order)
        found = reader(str(written("mphtxt", mesh, tmp_path)))
        found.parse()
        nodes, told = found.mesh["vertices"], found.mesh["element"]
        faces = np.array(told[tri]["idx"]).reshape(-1, mesh.faces.shape[1])
        elements = told[tet]["Element"]
        if order == 2:
            faces, elements = faces[:, [0, 1, 2, 3, 5, 4]], elements[:, [0, 1, 2, 3, 4, 6, 5, 7, 8, 9]]
        volume = elements_volume(nodes, elements, 4) / elements_volume(mesh.nodes, mesh.elements, 4) - 1
        area = faces_area(nodes, faces, 4) / faces_area(mesh.nodes, mesh.faces, 4) - 1
        labels = {part["Label"]: part["dimension"] for part in found.geometry.values()}
        assert labels == {"side": 2, "first-face": 2, "body": 3}
        assert abs(volume) < 1e-14
        assert abs(area) < 1e-14
        named = ", ".join(f"{label} ({dimension}-D)" for label, dimension in labels.items())
        rows.append((order, len(elements), f"{volume:.1e}", f"{area:.1e}", named))
    proof(
        "mphtxt",
        "COMSOL mphtxt read back by fealpy 3.4.0's reader: against the mesh that was written",
        ("order", "elements", "error of V", "error of S", "selections"),
        rows,
    )
