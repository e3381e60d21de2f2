"""Exact loops, planes at all vertex heights, corners kept: fem's V and S are exact by both meshers."""

import numpy as np
import pytest

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.tet_mesh_check import check_tet_mesh
from stackloft_plugins.integrators.fem import Fem
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.meshers.sweep import Sweep
from stackloft_plugins.meshers.tetwild import Tetwild
from stackloft_plugins.reconstructors.loft import LoftReconstructor

SQUARE, HOLE = [(0, 0), (30, 0), (30, 20), (0, 20)], [(10, 6), (10, 14), (18, 14), (18, 6)]
L_BLOCK = [(0, 0), (40, 0), (40, 10), (10, 10), (10, 30), (0, 30)]
HEXAGON = [(20 * np.cos(a), 20 * np.sin(a)) for a in np.arange(6) * np.pi / 3]
HEIGHTS = (0.0, 8.0, 14.0, 24.0, 32.0)
TURN = np.array([[np.cos(0.3), np.sin(0.3)], [-np.sin(0.3), np.cos(0.3)]])


def loop(ring, *, hole=False):
    return Loop(np.array(ring, dtype=float) @ TURN, corners=np.arange(len(ring)), hole=hole)


def stack(outer, inner=None, *, low=0.0, high=32.0):
    """Sections at all heights of vertices; the inner loop from `low` to `high`."""

    def loops(z):
        return (
            (loop(outer),) if inner is None or not low <= z <= high else (loop(outer), loop(inner, hole=True))
        )

    return ContourStack(tuple(Section(z, loops(z), f"{z} mm") for z in HEIGHTS))


LOOPS = {
    "box": (stack(SQUARE), 600 * 32, 2 * 600 + 100 * 32),
    "prism": (stack(HEXAGON), 600 * 3**0.5 * 32, 1200 * 3**0.5 + 120 * 32),
    "L-block": (stack(L_BLOCK), 600 * 32, 2 * 600 + 140 * 32),
    "box with a square through-hole": (
        stack(SQUARE, HOLE),
        (600 - 64) * 32,
        2 * (600 - 64) + (100 + 32) * 32,
    ),
    "box with a closed box cavity": (
        stack(SQUARE, HOLE, low=8.0, high=24.0),
        600 * 32 - 64 * 16,
        2 * 600 + 100 * 32 + 2 * 64 + 32 * 16,
    ),
}
CAVITY = "box with a closed box cavity"


def lofted(name):
    return LoftReconstructor(ends="face").reconstruct(LOOPS[name][0])


def mesher(kind, order, elements):
    return (Sweep if kind == "sweep" else Tetwild)(order=order, elements=elements)


CASES = [
    *(("sweep", name, order) for name in LOOPS if name != CAVITY for order in (1, 2)),
    ("tetwild", CAVITY, 1),  # test_tetwild has the through-hole
]


@pytest.mark.parametrize("name", LOOPS)
def test_the_loft_is_exact(name):
    found = SurfaceGauss().integrate(lofted(name))
    assert (found.volume, found.area) == pytest.approx(LOOPS[name][1:], rel=1e-12)


@pytest.mark.parametrize(("kind", "name", "order"), CASES)
def test_plane_faced_bodies_are_exact(kind, name, order):
    mesh = mesher(kind, order, 400).mesh(lofted(name))
    found = Fem().integrate(mesh)
    assert (found.volume, found.area) == pytest.approx(LOOPS[name][1:], rel=1e-10)
    assert check_tet_mesh(mesh).inverted == 0
    for group, z in (("first-face", 0.0), ("last-face", 32.0)):
        np.testing.assert_allclose(mesh.nodes[mesh.faces_of(group), 2], z, atol=1e-9)


def test_a_cavity_s_faces_must_be_told_and_seen():
    told = LoftReconstructor(ends="face", inner_ends="face")
    for options in ({"ends": "face", "inner_ends": "areas"}, {"ends": "flat:0.001mm"}):
        guessed = SurfaceGauss().integrate(LoftReconstructor(**options).reconstruct(LOOPS[CAVITY][0]))
        assert guessed.volume < 0.99 * LOOPS[CAVITY][1], "half-way to the sections without it"
    with pytest.raises(InputError, match=r"14\.0 mm: a loop that one section alone shows"):
        told.reconstruct(stack(SQUARE, HOLE, low=14.0, high=14.0))
    with pytest.raises(InputError, match="several shells"):
        Sweep().mesh(lofted(CAVITY))


@pytest.mark.prove
def test_prove_exact_loops(proof):
    rows = []
    for name, (_, volume, area) in LOOPS.items():
        for kind in ("sweep", "tetwild"):
            for order in (1, 2):
                if (kind, name) == ("sweep", CAVITY):
                    continue
                mesh = mesher(kind, order, 2000).mesh(lofted(name))
                found, validity = Fem().integrate(mesh), mesh.validity()
                off = found.volume / volume - 1, found.area / area - 1
                least = f"{validity.min_scaled_jacobian:.3f}"
                told = (f"{part:.1e}" for part in off)
                rows.append([name, kind, order, len(mesh.elements), *told, least, validity.inverted])
                assert max(map(abs, off)) < 1e-10, (name, kind, order)
                assert validity.inverted == 0
    proof(
        "exact-loops",
        "Exact loops by both meshers, against the bodies' exact volume and area",
        ["body", "mesher", "order", "elements", "error of V", "error of S", "smallest scaled Jacobian",
         "inverted"],
        rows,
    )  # fmt: skip
