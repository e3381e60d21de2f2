"""Sweep and fem on lofts of exact sections: exact on plane faces, to their order on curved ones."""

import time

import numpy as np
import pytest

from stackloft.geometry.exact_surface import ExactSurface
from stackloft.geometry.lagrange_simplex import tet_lattice
from stackloft.geometry.sharp_lines import sharp_columns
from stackloft.geometry.tube_stations import tube_lengths
from stackloft.model.arrays import frozen_floats
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import LoftedSolid, Shell, ShellEnd
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tet_mesh_check import check_tet_mesh
from stackloft.testing import phantoms
from stackloft_plugins.integrators.fem import Fem
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.meshers.sweep import Sweep
from stackloft_plugins.reconstructors.loft import LoftReconstructor

ROUND = {
    "sphere": ("ellipsoid", {"a": 25, "b": 25, "c": 25}),
    "ellipsoid": ("ellipsoid", {}),
    "potato": ("potato", {"seed": 1}),
}
L_SHAPE = np.array([[0.0, 0], [30, 0], [30, 12], [10, 12], [10, 40], [0, 40]])


def lofted(name, sections=11, points=33, **parameters):
    phantom = phantoms.make(name, **parameters)
    return LoftReconstructor(points=points).reconstruct(phantom.contour_stack(sections=sections))


def flat_ended(polygon, positions, rotation=0.0):
    c, s = np.cos(rotation), np.sin(rotation)
    loop = Loop(frozen_floats(polygon @ np.array([[c, s], [-s, c]])), np.arange(len(polygon)))
    stack = ContourStack(tuple(Section(float(z), (loop,), f"z={z}") for z in positions))
    return LoftReconstructor(ends="face").reconstruct(stack)


def errors(solid, **options):
    """Relative errors of V and S against the loft itself, and the mesh."""
    mesh = Sweep(**options).mesh(solid)
    loft, found = SurfaceGauss().integrate(solid), Fem().integrate(mesh)
    return abs(found.volume / loft.volume - 1), abs(found.area / loft.area - 1), mesh


@pytest.mark.parametrize(("order", "most", "bound"), [(2, 5_000, 2e-5), (2, 10_000, 5e-6), (3, 5_000, 2e-6)])
@pytest.mark.parametrize("name", ROUND)
def test_curved_elements_hold_what_the_loft_says(name, order, most, bound):
    body, parameters = ROUND[name]
    volume, area, mesh = errors(lofted(body, **parameters), order=order, elements=most)
    assert len(mesh.elements) <= most
    assert mesh.order == order
    assert check_tet_mesh(mesh).inverted == 0
    assert volume < bound
    assert area < bound


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(
    ("polygon", "volume", "area"),
    [
        (np.array([[0.0, 0], [30, 0], [30, 20], [0, 20]]), 30 * 20 * 40, 2 * (30 * 20 + 30 * 40 + 20 * 40)),
        (np.array([[0.0, 0], [30, 0], [0, 40]]), 600 * 40, 2 * 600 + 40 * 120),
        (L_SHAPE, (30 * 12 + 28 * 10) * 40, 2 * (30 * 12 + 28 * 10) + 40 * 140),
    ],
    ids=["box", "prism", "L-block"],
)
def test_plane_faces_are_exact(polygon, volume, area, order):
    solid = flat_ended(polygon, [0.0, 13.0, 40.0], rotation=0.3)
    mesh = Sweep(order=order).mesh(solid)
    found = Fem().integrate(mesh)
    assert found.volume == pytest.approx(volume, rel=1e-10)
    assert found.area == pytest.approx(area, rel=1e-10)
    part = {name: Fem().integrate(mesh) and mesh.faces_of(name) for name in mesh.group_names}
    assert set(part) == {"side", "first-face", "last-face"}
    for name, z in (("first-face", 0.0), ("last-face", 40.0)):
        assert len(part[name]) > 0
        np.testing.assert_allclose(mesh.nodes[part[name], 2], z, atol=1e-12)


def test_boundary_nodes_lie_on_the_loft_and_edges_on_its_corner_lines():
    solid = lofted("potato", seed=3)
    mesh = Sweep(order=3, elements=2000).mesh(solid)
    surface = ExactSurface(solid.shells[0].patches)
    off = surface.project(mesh.nodes[np.unique(mesh.faces)]).distance.max()
    assert off < 1e-9
    box = flat_ended(np.array([[0.0, 0], [30, 0], [30, 20], [0, 20]]), [0.0, 40.0])
    corners = np.flatnonzero(sharp_columns(box.shells[0].patches))
    lines = box.shells[0].patches[0, corners, 0, 0, :2]
    fine = Sweep(elements=800).mesh(box)
    side = fine.nodes[np.unique(fine.faces_of("side"))]
    for line in lines:
        assert (np.linalg.norm(side[:, :2] - line, axis=1) < 1e-9).sum() >= 3


def test_two_rings_of_elements_surround_a_pole():
    solid = lofted("ellipsoid", sections=3, points=9)
    mesh = Sweep(order=1, elements=300).mesh(solid)
    pole = solid.shells[0].patches[0, 0, 0, 0]
    tip = int(np.argmin(np.linalg.norm(mesh.nodes - pole, axis=1)))
    first = np.unique(mesh.faces[(mesh.faces == tip).any(axis=1)])
    second = np.unique(mesh.faces[np.isin(mesh.faces, first).any(axis=1)])
    section = solid.shells[0].patches[0, 0, 3, 0, 2]
    assert mesh.nodes[second, 2].max() <= section + 1e-9


@pytest.mark.parametrize("name", ["banana", "apple", "two-lobed", "dumbbell", "meat", "cone", "twisted-bar"])
def test_other_shapes_are_carried_too(name):
    plane = {"cone": "flat:3,point", "twisted-bar": "face"}
    stack = phantoms.make(name).contour_stack(placing="faces" if name == "twisted-bar" else "mid")
    solid = LoftReconstructor(ends=plane.get(name)).reconstruct(stack)
    for order in (1, 2):
        volume, area, mesh = errors(solid, order=order)
        assert check_tet_mesh(mesh).inverted == 0
        assert max(volume, area) < {1: 2e-2, 2: 5e-4}[order]


def kidney(positions):
    angle = np.linspace(0.35, 2 * np.pi - 0.35, 60)
    outer = 20 * np.column_stack([np.cos(angle), np.sin(angle)])
    inner = 11 * np.column_stack([np.cos(angle[::-1]), np.sin(angle[::-1])])
    return flat_ended_smooth(np.vstack([outer, inner]), positions)


def flat_ended_smooth(polygon, positions):
    loop = Loop(frozen_floats(polygon), np.array([0, 59, 60, 119]))
    stack = ContourStack(tuple(Section(float(z), (loop,), f"z={z}") for z in positions))
    return LoftReconstructor(points=60, ends="face").reconstruct(stack)


def test_a_section_that_is_not_seen_whole_from_its_middle_is_filled_by_delaunay():
    volume, area, mesh = errors(kidney([0.0, 10.0, 20.0]), order=2, elements=20_000)
    assert check_tet_mesh(mesh).inverted == 0
    assert max(volume, area) < 2e-5


@pytest.mark.parametrize(("order", "bound"), [(1, 1e-2), (2, 2e-5), (3, 2e-6)])
def test_a_tube_is_carried_as_a_ring(order, bound):
    solid = LoftReconstructor(ends="face").reconstruct(
        phantoms.make("tube").contour_stack(sections=11, placing="faces")
    )
    volume, area, mesh = errors(solid, order=order)
    assert check_tet_mesh(mesh).inverted == 0
    assert max(volume, area) < bound
    assert len(mesh.elements) <= 5000


def test_a_hole_far_from_the_middle_is_met_by_delaunay():
    hole = np.array([[2.0, 2], [2, 5], [6, 5], [6, 2]])
    loops = (Loop(frozen_floats(L_SHAPE), np.arange(6)), Loop(frozen_floats(hole), np.arange(4), hole=True))
    stack = ContourStack(tuple(Section(z, loops, f"z={z}") for z in (0.0, 13.0, 40.0)))
    mesh = Sweep().mesh(LoftReconstructor(ends="face").reconstruct(stack))
    found = Fem().integrate(mesh)
    assert found.volume == pytest.approx((30 * 12 + 28 * 10 - 12) * 40, rel=1e-10)
    assert found.area == pytest.approx(2 * (30 * 12 + 28 * 10 - 12) + 40 * (140 + 14), rel=1e-10)


def test_the_wanted_size_is_kept_on_the_surface():
    solid = lofted("ellipsoid")
    for size in (8.0, 4.0, 2.0):
        mesh = Sweep(order=1, max_element_size=size).mesh(solid)
        a, b, c = (mesh.nodes[mesh.faces[:, k]] for k in range(3))
        sides = np.stack([np.linalg.norm(x, axis=1) for x in (b - a, c - b, a - c)])
        assert 0.4 * size < sides.max() <= 1.01 * size


def test_refusals():
    solid = lofted("ellipsoid")
    shell = solid.shells[0]
    with pytest.raises(InputError, match="several shells"):
        Sweep().mesh(LoftedSolid((shell, shell)))
    ring = LoftedSolid((Shell(shell.patches[1:-1], (ShellEnd.OPENING, ShellEnd.FACE)),))
    with pytest.raises(InputError, match=r"an end of the kind opening.*fem-tetwild"):
        Sweep().mesh(ring)
    torus = phantoms.make("torus").contour_stack(sections=11)
    with pytest.raises(InputError, match="closes over its ridge"):
        Sweep().mesh(LoftReconstructor().reconstruct(torus))
    with pytest.raises(InputError, match="no surface"):
        Sweep().mesh(LoftedSolid(()))
    mesh = Sweep(elements=500).mesh(solid)
    turned = TetMesh(mesh.nodes * [1, 1, -1], mesh.elements, mesh.faces, mesh.groups, mesh.group_names)
    with pytest.raises(InputError, match=r"of 4\d\d elements are turned over.*at \("):
        Fem().integrate(turned)


def halvings(solid, order, counts):
    """Relative errors of V and S, signed, with each patch along the loop cut into so many; the elements."""
    longest = tube_lengths(solid.shells[0].patches)[1].max()
    loft, rows = SurfaceGauss().integrate(solid), []
    for count in counts:
        mesh = Sweep(order=order, max_element_size=np.sqrt(2) * 1.0001 * longest / count).mesh(solid)
        found = Fem().integrate(mesh)
        rows.append((found.volume / loft.volume - 1, found.area / loft.area - 1, len(mesh.elements)))
    return np.array(rows)


@pytest.mark.parametrize(("order", "low", "high"), [(1, 1.6, 2.4), (2, 3.5, 4.5)])
def test_errors_fall_with_the_elements_order(order, low, high):
    found = halvings(lofted("ellipsoid", sections=7, points=17), order, (1, 2, 4))
    assert (found[:, :2] < 0).all()  # inscribed
    observed = np.log2(found[:-1, 0] / found[1:, 0])
    assert (observed > low).all()
    assert (observed < high).all()


def test_inner_nodes_are_straight_where_they_can_be():
    mesh = Sweep(order=2, elements=1000).mesh(lofted("ellipsoid"))
    free = np.setdiff1d(np.arange(len(mesh.nodes)), np.unique(mesh.faces))
    straight = np.einsum("kc,mcd->mkd", tet_lattice(2) / 2, mesh.nodes[mesh.elements[:, :4]])
    off = np.linalg.norm(mesh.nodes[mesh.elements] - straight, axis=2)
    assert off[np.isin(mesh.elements, free)].max() < 1e-9


@pytest.mark.prove
def test_the_claims_in_figures(proof):
    rows = []
    for name, (body, parameters) in ROUND.items():
        solid = lofted(body, **parameters)
        for order, most, bound in ((1, 5_000, 2e-2), (2, 5_000, 2e-5), (2, 10_000, 5e-6), (3, 5_000, 2e-6)):
            start = time.process_time()
            Sweep(order=order, elements=most).mesh(solid)
            seconds = time.process_time() - start
            volume, area, mesh = errors(solid, order=order, elements=most)
            validity = mesh.validity()
            rows.append(
                (
                    name,
                    order,
                    len(mesh.elements),
                    f"{volume:.1e}",
                    f"{area:.1e}",
                    f"{bound:.0e}",
                    validity.inverted,
                    f"{validity.min_scaled_jacobian:.3f}",
                    f"{seconds:.2f}",
                    "",
                )
            )
            assert max(volume, area) < bound
            assert validity.inverted == 0
        for sections, points in ((5, 12), (7, 17)):
            coarse = lofted(body, sections=sections, points=points, **parameters)
            found = halvings(coarse, 2, (1, 2, 4, 8))
            observed = np.log2(found[:-1, 0] / found[1:, 0])
            what = f"{name}, {sections} sections, {points} points"
            rows += [
                (what, 2, int(count), f"{-volume:.1e}", f"{-area:.1e}", "", "", "", "", order)
                for (volume, area, count), order in zip(
                    found, ["", *(f"{x:.2f}" for x in observed)], strict=True
                )
            ]
            assert ((observed > 3.5) & (observed < 4.5)).all()
    for name, polygon in (
        ("box", np.array([[0.0, 0], [30, 0], [30, 20], [0, 20]])),
        ("L-block", L_SHAPE),
        ("prism", np.array([[0.0, 0], [30, 0], [0, 40]])),
    ):
        for order in (1, 2, 3):
            volume, area, mesh = errors(flat_ended(polygon, [0.0, 13.0, 40.0], 0.3), order=order)
            least = mesh.validity().min_scaled_jacobian
            rows.append(
                (
                    name,
                    order,
                    len(mesh.elements),
                    f"{volume:.1e}",
                    f"{area:.1e}",
                    "1e-10",
                    0,
                    f"{least:.3f}",
                    "",
                    "",
                )
            )
            assert max(volume, area) < 1e-10
    proof(
        "fem-sweep",
        "Sweep and fem against the loft that was meshed: relative errors, and the observed order of V",
        (
            "loft of",
            "order",
            "elements",
            "V error",
            "S error",
            "bound",
            "inverted",
            "smallest scaled Jacobian",
            "CPU seconds",
            "order of V",
        ),
        rows,
    )
