"""Repair mends what is broken, tells what it changed, refuses what stays open, and says what is missing."""

import numpy as np
import pytest

import stackloft
from stackloft.geometry.closed_mesh import mesh_integrals, unmatched_edges
from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.errors import InputError, PluginError
from stackloft.model.tri_mesh import TriMesh
from stackloft.testing.conformance import ellipsoids
from stackloft_plugins.reconstructors.repair import Repair

WHOLE = ellipsoids.tri_mesh(2)
EXACT = mesh_integrals(WHOLE.vertices, WHOLE.faces)


def broken(faces, vertices=WHOLE.vertices):
    return TriMesh(frozen_floats(vertices), frozen_ints(faces))


def soup():
    """Every triangle with corners of its own, as in STL."""
    return broken(np.arange(3 * len(WHOLE.faces)).reshape(-1, 3), WHOLE.vertices[WHOLE.faces].reshape(-1, 3))


BROKEN = {
    "duplicate triangles": broken(np.vstack([WHOLE.faces, WHOLE.faces[:9]])),
    "degenerate triangles": broken(np.vstack([WHOLE.faces, [[0, 0, 1], [5, 6, 6]]])),
    "a fin on an edge": broken(
        np.vstack([WHOLE.faces, [[WHOLE.faces[0, 0], WHOLE.faces[0, 1], len(WHOLE.vertices)]]]),
        np.vstack([WHOLE.vertices, [[31.0, -17.0, 160.0]]]),
    ),
    "a hole": broken(np.delete(WHOLE.faces, [3, 40, 41], axis=0)),
    "triangles turned over": broken(np.vstack([WHOLE.faces[:30, ::-1], WHOLE.faces[30:]])),
    "inside out": broken(WHOLE.faces[:, ::-1]),
    "no shared corners": soup(),
}


@pytest.mark.parametrize("case", BROKEN)
def test_what_is_broken_is_mended_and_told(case):
    mended = Repair().reconstruct(BROKEN[case])
    assert unmatched_edges(mended.faces) == 0
    assert mesh_integrals(mended.vertices, mended.faces) == pytest.approx(EXACT, rel=0.02)
    told = [notice.message for notice in mended.notices if notice.code == "surface-repaired"]
    assert told or case == "no shared corners"
    assert all("triangles" in line or "area" in line for line in told)


def test_a_whole_surface_stays_as_it_is():
    mended = Repair().reconstruct(WHOLE)
    assert mesh_integrals(mended.vertices, mended.faces) == pytest.approx(EXACT, rel=1e-12)
    assert not mended.notices


def test_parts_that_cut_each_other_are_taken_apart():
    spike = WHOLE.vertices.copy()
    top = int(np.argmax(spike[:, 2]))
    spike[top] = [31.0, -17.0, 100.0]  # from the top through the body and out of its bottom
    mended = Repair().reconstruct(broken(WHOLE.faces, spike))
    assert unmatched_edges(mended.faces) == 0
    assert mesh_integrals(mended.vertices, mended.faces)[0] == pytest.approx(EXACT[0], rel=0.1)
    assert any("self-intersections" in notice.message for notice in mended.notices)


def test_remeshing_to_an_edge_length():
    mended = Repair(edge_length=2.0).reconstruct(WHOLE)
    ends = mended.vertices[mended.faces]
    edges = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2)
    assert np.median(edges) == pytest.approx(2.0, rel=0.2)
    assert mesh_integrals(mended.vertices, mended.faces) == pytest.approx(EXACT, rel=0.02)
    assert "remeshing" in mended.notices[-1].message


def test_what_stays_open_is_refused():
    with pytest.raises(InputError, match=r"stays open after repair.*hole_size above 0"):
        Repair(hole_size=0).reconstruct(BROKEN["a hole"])
    with pytest.raises(InputError, match="no triangle"):
        Repair().reconstruct(broken(WHOLE.faces[:0]))


def test_it_is_a_method_of_its_own():
    result = stackloft.measure(BROKEN["a hole"], "repair")
    assert result.objects[0].volume.value == pytest.approx(EXACT[0], rel=0.02)
    assert any(notice.code == "surface-repaired" for notice in result.warnings)


def test_without_libgl_the_packages_are_named_and_the_rest_works(tmp_path, monkeypatch):
    """An import of pymeshlab that fails as it does on a minimal image."""
    words = "libOpenGL.so.0: cannot open shared object file: No such file or directory"
    (tmp_path / "pymeshlab.py").write_text(f"raise ImportError({words!r})\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(PluginError, match="apt-get install libgl1 libopengl0") as caught:
        Repair().reconstruct(BROKEN["a hole"])
    assert "libOpenGL.so.0" in str(caught.value)
    assert stackloft.measure(WHOLE).objects[0].volume.value == pytest.approx(EXACT[0])
