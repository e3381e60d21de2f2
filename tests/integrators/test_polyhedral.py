"""A triangle surface is measured exactly, or refused."""

import numpy as np
import pytest

from stackloft.geometry.closed_mesh import mesh_integrals, unmatched_edges
from stackloft.model.bias import Bias
from stackloft.model.errors import InputError
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.integrators.polyhedral import Polyhedral

CORNERS = np.array([[x, y, z] for x in (0.0, 2.0) for y in (0.0, 3.0) for z in (0.0, 5.0)])
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
BOX = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))])


def test_a_box_is_exact_wherever_it_stands():
    for shift in (0.0, 1e6):
        found = Polyhedral().integrate(TriMesh(CORNERS + shift, BOX))
        assert found.volume == pytest.approx(30.0, rel=1e-9)
        assert found.area == pytest.approx(62.0, rel=1e-9)


def test_a_cavity_is_taken_off_and_its_skin_added():
    inner = 0.5 * CORNERS + [0.5, 0.7, 1.0]
    hollow = TriMesh(np.concatenate([CORNERS, inner]), np.concatenate([BOX, BOX[:, ::-1] + 8]))
    found = Polyhedral().integrate(hollow)
    assert found.volume == pytest.approx(30.0 * 7 / 8, rel=1e-12)
    assert found.area == pytest.approx(62.0 * 5 / 4, rel=1e-12)


@pytest.mark.parametrize(
    ("faces", "told"),
    [
        (BOX[:-1], "3 edges"),
        (np.concatenate([BOX[:1, ::-1], BOX[1:]]), "disagree|do not agree"),
        (BOX[:, ::-1], "inside out"),
        (BOX[:0], "no triangle"),
        (np.concatenate([BOX, BOX[:1]]), "three triangles or more"),
    ],
)
def test_what_encloses_nothing_is_refused(faces, told):
    with pytest.raises(InputError, match=told):
        Polyhedral().integrate(TriMesh(CORNERS, faces))


def test_degenerate_triangles_do_no_harm():
    flat = np.concatenate([BOX, [[0, 0, 1], [1, 0, 0]]])
    assert unmatched_edges(flat) == 0
    assert mesh_integrals(CORNERS, flat)[0] == pytest.approx(30.0)


def test_a_biased_surface_says_so():
    known = Bias(8.0, 10.0, "stairs")
    found = Polyhedral().integrate(TriMesh(CORNERS, BOX, biased="stairs", area_bias=known))
    assert [(x.code, x.message) for x in found.notices] == [("area-biased", "stairs")]
    assert found.area_bias is known
