"""Tetrahedra by fTetWild: exact on plane faces, on the loft elsewhere, and no way to kill the process."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stackloft.geometry.closed_mesh import mesh_integrals
from stackloft.geometry.surface_regions import surface_regions
from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.tri_mesh import TriMesh
from stackloft.testing import phantoms
from stackloft.testing.conformance import ellipsoids
from stackloft_plugins.integrators.fem import Fem
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.meshers.boundary_target import boundary_target
from stackloft_plugins.meshers.sizing_field import curvature, sizing_field
from stackloft_plugins.meshers.tetwild import Tetwild
from stackloft_plugins.meshers.tetwild_body import body_of
from stackloft_plugins.meshers.tetwild_call import Wanted, tetrahedra
from stackloft_plugins.reconstructors.loft import LoftReconstructor
from stackloft_plugins.worker import Limits, WorkerError, run_alone

TURN = Rotation.from_euler("xyz", [20, 33, 50], degrees=True).as_matrix()
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
BOX = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))])


def corners(low, high):
    return np.array(
        [
            [x, y, z]
            for x, y, z in np.stack(np.meshgrid(*zip(low, high, strict=True), indexing="ij"), -1).reshape(
                -1, 3
            )
        ]
    )


def surface(vertices, faces, shift=(100.0, 20.0, -3.0)):
    return TriMesh(frozen_floats(vertices @ TURN.T + shift), frozen_ints(faces))


OCTAHEDRON = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
SURFACES = {
    "rotated box": surface(corners((0, 0, 0), (20, 30, 50)), BOX),
    "tetrahedron": surface(
        10 * np.vstack([np.zeros(3), np.eye(3)]), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    ),
    "octahedron": surface(20.0 * np.vstack([np.eye(3), -np.eye(3)])[[0, 3, 1, 4, 2, 5]], OCTAHEDRON),
    "box with a closed box cavity": surface(
        np.vstack([corners((0, 0, 0), (20, 30, 50)), corners((5, 6, 10), (12, 14, 30))]),
        np.vstack([BOX, BOX[:, ::-1] + 8]),
    ),
}
SQUARE, HOLE = [(0, 0), (30, 0), (30, 20), (0, 20)], [(10, 6), (10, 14), (18, 14), (18, 6)]
L_BLOCK = [(0, 0), (40, 0), (40, 10), (10, 10), (10, 30), (0, 30)]
HEXAGON = [(20 * np.cos(a), 20 * np.sin(a)) for a in np.arange(6) * np.pi / 3]


def loop(ring, *, hole=False):
    return Loop(np.array(ring, dtype=float), corners=np.arange(len(ring)), hole=hole)


def stack(*loops):
    heights = (0.0, 5.0, 10.0, 20.0, 25.0, 32.0)
    return ContourStack(tuple(Section(z, loops, f"{z} mm") for z in heights))


LOOPS = {
    "box": (stack(loop(SQUARE)), 600 * 32, 2 * 600 + 100 * 32),
    "prism": (stack(loop(HEXAGON)), 600 * 3**0.5 * 32, 1200 * 3**0.5 + 120 * 32),
    "l-block": (stack(loop(L_BLOCK)), 600 * 32, 2 * 600 + 140 * 32),
    "box with a square hole": (
        stack(loop(SQUARE), loop(HOLE, hole=True)),
        (600 - 64) * 32,
        2 * (600 - 64) + (100 + 32) * 32,
    ),
}


def figures(mesh):
    found = Fem().integrate(mesh)
    return found.volume, found.area


def exact_case(name):
    if name in SURFACES:
        body = SURFACES[name]
        return body, mesh_integrals(body.vertices, body.faces)
    sections, volume, area = LOOPS[name]
    return LoftReconstructor(ends="face").reconstruct(sections), (volume, area)


@pytest.mark.parametrize(("name", "order"), [("octahedron", 1), ("box with a square hole", 2)])
def test_plane_faced_bodies_are_exact(name, order):
    body, exact = exact_case(name)
    mesh = Tetwild(order=order, elements=300).mesh(body)
    assert figures(mesh) == pytest.approx(exact, rel=1e-10)
    assert mesh.validity().inverted == 0
    assert mesh.volume_uncertainty <= 1e-9 * exact[0]
    sides = {name: len(mesh.faces_of(name)) for name in mesh.group_names}
    assert min(sides.values()) > 0
    assert len(sides) == (8 if name == "octahedron" else 3)


def test_a_curved_loft_is_met_and_its_own_error_told():
    solid = ellipsoids.lofted_solid(2)
    exact = SurfaceGauss().integrate(solid)
    mesh = Tetwild(elements=300, curvature_factor=1.5).mesh(solid)
    volume, area = figures(mesh)
    assert volume == pytest.approx(exact.volume, rel=1e-3)
    assert area == pytest.approx(exact.area, rel=1e-3)
    assert mesh.volume_uncertainty == pytest.approx(abs(volume - exact.volume), rel=1e-3)
    assert mesh.validity().inverted == 0


def wrong(**changes):
    box = SURFACES["rotated box"]
    return replace(box, **changes)


def with_vertex(value):
    vertices = SURFACES["rotated box"].vertices.copy()
    vertices[3, 1] = value
    return wrong(vertices=frozen_floats(vertices))


def with_index(value):
    faces = BOX.copy()
    faces[5, 1] = value
    return wrong(faces=frozen_ints(faces))


WAYS_TO_KILL = {
    "no points": (wrong(vertices=frozen_floats(np.zeros((0, 3)))), {}, "no point"),
    "no faces": (wrong(faces=frozen_ints(np.zeros((0, 3)))), {}, "no triangle"),
    "NaN": (with_vertex(np.nan), {}, "not finite"),
    "inf": (with_vertex(np.inf), {}, "not finite"),
    "index out of range": (with_index(10**6), {}, "names a vertex that does not exist"),
    "-1": (with_index(-1), {}, "names a vertex that does not exist"),
    "one triangle": (wrong(faces=frozen_ints(BOX[:1])), {}, "open"),
    "coincident points": (wrong(vertices=frozen_floats(np.ones((8, 3)))), {}, "no volume"),
    "flat body": (
        wrong(vertices=frozen_floats(corners((0, 0, 0), (20, 30, 50)) * [1, 1, 0])),
        {},
        "no volume",
    ),
    "open surface": (wrong(faces=frozen_ints(BOX[2:])), {}, r"open.*--method repair"),
    "inside out": (wrong(faces=frozen_ints(BOX[:, ::-1])), {}, "inside out"),
    "epsilon 0": (wrong(), {"epsilon": 0.0}, "envelope is too thin"),
    "epsilon 1e-9": (wrong(), {"epsilon": 1e-9}, "envelope is too thin"),
    "elements without number": (wrong(), {"max_element_size": 1e-4}, "too many"),
    "endless optimisation": (
        wrong(),
        {"quality": 3.0001, "elements": 30_000, "time_limit": 2.0},
        "within 2 s",
    ),
    "too much memory": (wrong(), {"memory_limit": 60.0}, "more than 60 MB"),
}


@pytest.mark.parametrize("way", WAYS_TO_KILL)
def test_every_way_to_kill_it_ends_in_one_clear_error(way):
    body, options, told = WAYS_TO_KILL[way]
    with pytest.raises(InputError, match=told) as caught:
        Tetwild(**{"elements": 300, **options}).mesh(body)
    assert "\n" not in str(caught.value)


def test_what_would_crash_this_process_crashes_the_worker_alone():
    box = SURFACES["rotated box"]
    faces = box.faces.astype(np.int32)
    faces[5, 1] = 10**6
    arrays = {"vertices": box.vertices - box.vertices.mean(axis=0), "faces": faces}
    values = {"size": 5.0, "epsilon": 1e-3, "energy": 10.0}
    with pytest.raises(WorkerError, match="SIGSEGV") as caught:
        run_alone("stackloft_plugins.meshers.tetwild_call:call", arrays, values, Limits(60, 2000), what="it")
    assert caught.value.kind == "crash"


@pytest.mark.parametrize("scale", [1e-9, 1e6])
def test_coordinates_of_any_size_come_out_right(scale):
    box = SURFACES["rotated box"]
    body = replace(box, vertices=frozen_floats(scale * (box.vertices - [100.0, 20.0, -3.0])))
    mesh = Tetwild(order=1, elements=200).mesh(body)
    assert figures(mesh) == pytest.approx((30_000 * scale**3, 6_200 * scale**2), rel=1e-10, abs=0.0)


def test_regions_edges_and_corners_of_a_cylinder():
    angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    vertices = np.vstack(
        [*(np.column_stack([ring, np.full(60, z)]) for z in (0.0, 3.0)), [[0, 0, 0], [0, 0, 3]]]
    )
    k, beside = np.arange(60), (np.arange(60) + 1) % 60
    faces = np.vstack(
        [
            np.column_stack([k, beside, beside + 60]),
            np.column_stack([k, beside + 60, k + 60]),
            np.column_stack([beside, k, np.full(60, 120)]),
            np.column_stack([k + 60, beside + 60, np.full(60, 121)]),
        ]
    )
    body = TriMesh(frozen_floats(vertices), frozen_ints(faces))
    found = surface_regions(body.vertices, body.faces)
    assert (found.count, sorted(found.plane.tolist())) == (3, [False, True, True])
    assert (len(found.edges), len(found.corners)) == (120, 0)
    bend = curvature(body, found)[:120]
    assert np.allclose(bend, 1.0, rtol=0.2), "the cylinder's radius is 1; its rims do not count"
    points, cells, lengths = sizing_field(body, found, largest=0.5, factor=4.0)
    assert lengths.min() == pytest.approx(0.25, rel=0.25)
    assert lengths.max() == 0.5
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    assert (np.abs(np.linalg.det(edges)) > 0).all()


def test_a_plane_end_that_the_surface_runs_into_smoothly_is_part_of_what_is_met():
    """A torus closes over its ridge in a narrow plane ring, where no patch lies."""
    solid = LoftReconstructor().reconstruct(phantoms.make("torus").contour_stack(sections=7))
    body = body_of(solid)
    surface = body.surface(0.2)
    target = boundary_target(surface, body.patches, body.ends())
    assert not target.regions.plane.all()
    on_end = surface.vertices[surface.faces[target.flat]].mean(axis=1)
    assert len(on_end) > 20
    region = target.regions.region[target.flat]
    for number in np.unique(region):
        mine = on_end[region == number]
        np.testing.assert_allclose(target.on_region(int(number))(mine), mine, atol=1e-9)


@pytest.mark.parametrize("name", LOOPS)
def test_no_part_of_a_sharp_edge_is_without_its_line(name):
    """A gap would draw all nodes beside it to its two ends, and leave elements without volume."""
    body = body_of(exact_case(name)[0])
    target = boundary_target(body.surface(0.05), body.patches, body.ends())
    ends = target.surface.vertices[target.regions.edges]
    sides = target.regions.sides
    for a, b in np.unique(sides, axis=0).tolist():
        own = ends[(sides == (a, b)).all(axis=1)]
        points = np.concatenate([own[:, 0] + t * (own[:, 1] - own[:, 0]) for t in (0.2, 0.5, 0.9)])
        found = target.on_edges(a, b)
        assert found is not None
        np.testing.assert_allclose(found(points), points, atol=1e-9)


@pytest.mark.prove
def test_prove_tetwild(proof):
    rows = []
    for name in (*SURFACES, *LOOPS):
        body, exact = exact_case(name)
        for order in (1, 2):
            mesh = Tetwild(order=order, elements=2000).mesh(body)
            rows.append(_row(f"{name}, order {order}", mesh, exact))
            assert figures(mesh) == pytest.approx(exact, rel=1e-10)
    for name in ("sphere", "ellipsoid", "potato"):
        axes = {"a": 30, "b": 30, "c": 30} if name == "sphere" else {}
        body = phantoms.make("ellipsoid" if name == "sphere" else name, **axes)
        solid = LoftReconstructor(height=body.height).reconstruct(body.contour_stack(sections=11))
        loft = SurfaceGauss().integrate(solid)
        exact = (loft.volume, loft.area)
        for order in (1, 2):
            mesh = Tetwild(order=order).mesh(solid)
            rows.append(_row(f"{name} lofted, order {order}", mesh, exact))
        rows.append(_linear_row(name, solid, exact))
        assert len(mesh.elements) <= 8000
        assert figures(mesh) == pytest.approx(exact, rel=1e-5)
    solid = ellipsoids.lofted_solid(6)
    loft = SurfaceGauss().integrate(solid)
    runs = [figures(Tetwild(elements=2000).mesh(solid)) for _ in range(5)]
    spread = np.std(np.array(runs) / [loft.volume, loft.area], axis=0, ddof=1)
    rows.append(["ellipsoid, order 2, five runs of 2000 elements: spread (one standard deviation)", "", "",
                 f"{spread[0]:.1e}", f"{spread[1]:.1e}", ""])  # fmt: skip
    proof(
        "tetwild",
        "Tetrahedra by fTetWild: volume and area against the body itself, or against the loft",
        ["body", "elements", "smallest scaled Jacobian", "error of V", "error of S", "turned over"],
        rows,
    )


def _row(name, mesh, exact):
    volume, area = figures(mesh)
    validity = mesh.validity()
    assert validity.inverted == 0
    off = (f"{found / true - 1:.1e}" for found, true in zip((volume, area), exact, strict=True))
    return [name, len(mesh.elements), f"{validity.min_scaled_jacobian:.3f}", *off, validity.inverted]


def _linear_row(name, solid, exact):
    """fTetWild's own tetrahedra, nothing moved."""
    diagonal = float(np.linalg.norm(np.ptp(solid.tessellate(0.5).vertices, axis=0)))
    epsilon = 1e-3 * diagonal
    target = boundary_target(solid.tessellate(0.2 * epsilon))
    wanted = Wanted(0.07 * diagonal, epsilon, 10.0, Limits(900, 4000))
    nodes, elements = tetrahedra(target.surface, wanted)
    edges = nodes[elements[:, 1:]] - nodes[elements[:, :1]]
    volume = float(np.linalg.det(edges).sum()) / 6.0
    shrunk = (volume - exact[0]) / exact[1] / epsilon
    label = (
        f"{name}, fTetWild's own linear elements, envelope {epsilon:.2g} mm: {shrunk:.1f} envelopes inside"
    )
    return [label, len(elements), "", f"{volume / exact[0] - 1:.1e}", "", ""]
