"""Edges that keep boundary faces from bending are found and cut; nothing else changes."""

import numpy as np
from scipy.spatial import Delaunay

from stackloft.geometry.bisected_tets import bisected, edges_in_the_way
from stackloft.geometry.tet_boundary import boundary_faces


def volumes(nodes, elements):
    return np.linalg.det(nodes[elements[:, 1:]] - nodes[elements[:, :1]]) / 6


def some_mesh():
    nodes = np.random.default_rng(3).uniform(-1, 1, (60, 3))
    elements = Delaunay(nodes).simplices.astype(np.int64)
    turned = volumes(nodes, elements) < 0
    elements[turned] = elements[turned][:, [0, 2, 1, 3]]
    return nodes, elements[volumes(nodes, elements) > 1e-12]


def test_cutting_edges_keeps_a_mesh_whole():
    nodes, elements = some_mesh()
    edges = elements[:40, [0, 2]]
    finer, cut = bisected(nodes, elements, edges)
    assert len(finer) > len(nodes)
    assert (volumes(finer, cut) > 0).all()
    assert np.isclose(volumes(finer, cut).sum(), volumes(nodes, elements).sum(), rtol=1e-13)
    before, after = boundary_faces(elements), boundary_faces(cut)
    assert len(after) >= len(before)
    pairs = np.sort(np.concatenate([after[:, [0, 1]], after[:, [1, 2]], after[:, [2, 0]]]), axis=1)
    assert (np.unique(pairs, axis=0, return_counts=True)[1] == 2).all()


def test_a_face_with_two_edges_on_one_rim_and_an_element_with_two_faces_side_by_side():
    """Two elements under a half disc: v lies on the rim between a and b, nearly straight."""
    nodes = np.array([[-1.0, 0, 0], [1, 0, 0], [0, 0.3, 0], [0, -0.2, -1]])
    elements = np.array([[0, 1, 2, 3]])
    elements = elements if volumes(nodes, elements)[0] > 0 else elements[:, [1, 0, 2, 3]]
    faces = boundary_faces(elements)
    names = [tuple(sorted(face)) for face in faces.tolist()]
    apart = np.arange(4)
    assert edges_in_the_way(nodes, elements, faces, apart).tolist() in ([[0, 1]], [[1, 0]])
    one_skin = np.where([name in {(0, 1, 2), (0, 1, 3)} for name in names], 7, apart)
    found = {tuple(sorted(edge)) for edge in edges_in_the_way(nodes, elements, faces, one_skin).tolist()}
    assert (2, 3) in found, "the edge opposite to the one that both faces have"
