"""Curved tetrahedra: the order of their nodes, their shapes, their validity and their boundary."""

import numpy as np
import pytest

from stackloft.geometry.lagrange_simplex import (
    OUTWARD_FACES,
    face_nodes,
    shape_slopes,
    shape_values,
    tet_lattice,
    triangle_lattice,
)
from stackloft.geometry.tet_boundary import boundary_faces
from stackloft.geometry.tet_jacobian import bezier_jacobians, jacobian_bounds
from stackloft.model.errors import InputError
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tet_mesh_check import check_tet_mesh

ORDERS = (1, 2, 3)
UNIT = np.vstack([np.zeros(3), np.eye(3)])


def vtk_nodes(order, cell, count):
    """Where VTK says that the nodes of a Lagrange cell lie."""
    cell.GetPointIds().SetNumberOfIds(count)
    cell.GetPoints().SetNumberOfPoints(count)
    cell.Initialize()
    flat = cell.GetParametricCoords()
    return np.array([flat[k] for k in range(3 * count)]).reshape(-1, 3) * order


@pytest.mark.parametrize("order", ORDERS)
def test_nodes_are_in_the_order_of_vtk(order):
    from vtkmodules.vtkCommonDataModel import vtkLagrangeTetra, vtkLagrangeTriangle  # noqa: PLC0415

    tets = vtk_nodes(order, vtkLagrangeTetra(), len(tet_lattice(order)))
    np.testing.assert_allclose(tets, tet_lattice(order)[:, 1:], atol=1e-12)
    triangles = vtk_nodes(order, vtkLagrangeTriangle(), len(triangle_lattice(order)))
    np.testing.assert_allclose(triangles[:, :2], triangle_lattice(order)[:, 1:], atol=1e-12)


def test_two_edges_are_exchanged_in_gmsh():
    import gmsh  # noqa: PLC0415

    gmsh.initialize(interruptible=False)
    try:
        _, dimension, order, count, flat, corners = gmsh.model.mesh.getElementProperties(11)
    finally:
        gmsh.finalize()
    assert (dimension, order, count, corners) == (3, 2, 10, 4)
    theirs = np.array(flat).reshape(-1, 3) * 2
    np.testing.assert_allclose(theirs[[0, 1, 2, 3, 4, 5, 6, 7, 9, 8]], tet_lattice(2)[:, 1:])


@pytest.mark.parametrize("order", ORDERS)
def test_each_shape_is_one_at_its_own_node(order):
    for dimension, lattice in ((2, triangle_lattice(order)), (3, tet_lattice(order))):
        np.testing.assert_allclose(
            shape_values(dimension, order, lattice[:, 1:] / order), np.eye(len(lattice)), atol=1e-12
        )
        at = np.random.default_rng(1).dirichlet(np.ones(dimension + 1), 5)[:, 1:]
        np.testing.assert_allclose(shape_slopes(dimension, order, at).sum(axis=2), 0.0, atol=1e-12)
        step = 1e-6 * np.eye(dimension)
        for axis in range(dimension):
            ahead, behind = (shape_values(dimension, order, at + s * step[axis]) for s in (1, -1))
            slopes = (ahead - behind) / 2e-6
            np.testing.assert_allclose(shape_slopes(dimension, order, at)[axis], slopes, atol=1e-8)


@pytest.mark.parametrize("order", ORDERS)
def test_faces_look_outwards(order):
    points = tet_lattice(order)[:, 1:] / order
    for face, nodes in zip(OUTWARD_FACES, face_nodes(order), strict=True):
        a, b, c = UNIT[list(face)]
        assert np.cross(b - a, c - a) @ (a - UNIT.mean(axis=0)) > 0
        np.testing.assert_allclose(points[nodes], triangle_lattice(order) @ UNIT[list(face)] / order)


def crumpled(order, count, amount, seed=0):
    rng = np.random.default_rng(seed)
    return tet_lattice(order)[None, :, 1:] / order + rng.normal(
        0, amount / order, (count, len(tet_lattice(order)), 3)
    )


@pytest.mark.parametrize("order", ORDERS)
def test_the_smallest_jacobian_lies_within_its_bounds(order):
    elements = crumpled(order, 300, 0.08)
    bounds = jacobian_bounds(elements)
    at = np.vstack([np.random.default_rng(2).dirichlet(np.full(4, 0.4), 20_000)[:, 1:], UNIT])
    columns = [shape_slopes(3, order, at)[axis] @ elements for axis in range(3)]
    smallest = np.einsum("mgd,mgd->mg", columns[0], np.cross(columns[1], columns[2])).min(axis=1)
    assert not ((smallest <= 0) & (bounds.low > 0)).any()  # none that is turned over is certified
    clear = smallest > 0.02
    assert (bounds.low[clear] > 0).all()  # and a good one is not accused, though its coefficients may be
    assert clear.sum() > 20
    if order == 3:
        assert (bezier_jacobians(elements)[clear].min(axis=1) < 0).any()
    assert (bounds.low <= bounds.high + 1e-15).all()


def test_straight_elements_have_verdicts_scaled_jacobian():
    import pyvista  # noqa: PLC0415

    elements = crumpled(1, 50, 0.2)
    grid = pyvista.UnstructuredGrid({10: np.arange(200).reshape(50, 4)}, elements.reshape(-1, 3))
    theirs = grid.cell_quality("scaled_jacobian")["scaled_jacobian"]
    np.testing.assert_allclose(jacobian_bounds(elements).low, theirs, atol=1e-12)
    regular = np.array([[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]], dtype=float)
    np.testing.assert_allclose(jacobian_bounds(regular[None]).low, 1.0)


def test_an_element_turned_over_at_its_edge_alone_is_found():
    element = tet_lattice(2)[:, 1:] / 2
    element[4] = [0.0, 0.0, 0.0]  # an edge node pushed all the way into its vertex
    assert jacobian_bounds(element[None]).low[0] <= 0
    element[4] = [0.3, 0.0, 0.0]
    assert jacobian_bounds(element[None]).low[0] > 0


CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
SIX = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]])


def cube(**changes):
    given = {"nodes": CUBE, "elements": SIX, "faces": boundary_faces(SIX)} | changes
    return TetMesh(**given)


def test_a_whole_mesh_is_let_through():
    validity = check_tet_mesh(cube())
    assert (validity.inverted, cube().order, len(cube().faces)) == (0, 1, 12)
    assert len(cube().faces_of("side")) == 12


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"elements": SIX[:0], "faces": SIX[:0, :3]}, "no elements"),
        ({"elements": SIX[:, :3]}, "not tetrahedra"),
        ({"elements": SIX + 1}, "an element names a node that does not exist"),
        ({"faces": boundary_faces(SIX)[1:]}, "not those of the elements"),
        ({"faces": boundary_faces(SIX)[:, ::-1]}, "not those of the elements"),
        ({"nodes": CUBE * np.nan}, "not finite"),
        ({"nodes": CUBE * [1, 1, -1]}, "6 of 6 elements are turned over"),
        ({"elements": np.vstack([SIX, SIX[:1]])}, "the elements overlap"),
        ({"groups": np.full(12, 3)}, "has no name"),
        ({"groups": np.zeros(3, int)}, "not one group per"),
    ],
)
def test_what_is_wrong_with_a_mesh_is_said(changes, words):
    with pytest.raises(InputError, match=words):
        check_tet_mesh(cube(**changes))


def test_an_inverted_element_is_told_where():
    nodes = np.vstack([CUBE, [[0.5, 0.5, 7.0]]])
    elements = np.vstack([SIX, [[4, 5, 6, 8]]])
    elements[-1] = elements[-1][[0, 2, 1, 3]]
    elements = elements[[0, 1, 2, 3, 4, 5, 6]]
    with pytest.raises(InputError, match=r"1 of 7 elements are turned over.*at \(0\.375, 0\.375, 2\.5\) mm"):
        check_tet_mesh(TetMesh(nodes, elements, boundary_faces(elements)))
