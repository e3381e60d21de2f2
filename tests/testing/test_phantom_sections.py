"""Sections lie on the body, add up to its volume, and are one loop where that is promised."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stackloft.model.errors import UsageError
from stackloft.testing import phantoms
from stackloft.testing.phantoms.nesting import contains

OFFSET = (31.7, -112.2, 957.3)


def off_boundary(phantom, loop, z):
    """Return the largest distance (mm) of the loop's points from the boundary: value over slope."""
    bench = np.column_stack([loop.points, np.full(len(loop.points), z)])
    own = phantom.rotation.T @ (bench - phantom.offset).T
    values = np.array([piece(own) for piece in phantom.body.fields])
    step = 1e-6
    slopes = np.array(
        [
            np.linalg.norm(
                [
                    (piece(own + step * e[:, None]) - piece(own - step * e[:, None])) / (2 * step)
                    for e in np.eye(3)
                ],
                axis=0,
            )
            for piece in phantom.body.fields
        ]
    )
    return np.abs((values / slopes).max(axis=0)).max()


@pytest.mark.parametrize("rotation", [None, 5, (20.0, 35.0, 50.0)])
@pytest.mark.parametrize("name", phantoms.SOLID)
def test_points_lie_on_the_boundary(name, rotation):
    phantom = phantoms.make(name, rotation=rotation, offset=OFFSET)
    for section in phantom.contour_stack(6, points=120).sections:
        for loop in section.loops:
            assert off_boundary(phantom, loop, section.z) < 1e-10


@pytest.mark.parametrize("rotation", [None, 5])
@pytest.mark.parametrize("name", [name for name in phantoms.SOLID if name not in {"box", "prism"}])
def test_points_are_spread_evenly_between_corners(name, rotation):
    phantom = phantoms.make(name, rotation=rotation, offset=OFFSET)
    for section in phantom.contour_stack(5, points=200).sections:
        for loop in section.loops:
            assert loop.signed_area > 0 or loop.hole
            gaps = np.hypot(*(np.roll(loop.points, -1, axis=0) - loop.points).T)
            edges = np.split(gaps, loop.corners) if len(loop.corners) else [gaps]
            for arc in edges:
                if len(arc) > 2:
                    assert arc.max() < 1.25 * arc.min()


@pytest.mark.parametrize("name", ["ellipsoid", "potato", "apple", "banana", "meat"])
def test_section_areas_add_up_to_the_volume(name):
    """∫A dz by Gauss, A from polygons of 200 and 400 points extrapolated (their error falls as 1/k²)."""
    phantom = phantoms.make(name, offset=OFFSET)
    low, high = phantom.extent()
    t, w = np.polynomial.legendre.leggauss(32)
    z = low + (high - low) * (1 + np.sin(t * np.pi / 2)) / 2  # smooths the square roots at the poles
    w = w * (high - low) / 2 * np.pi / 2 * np.cos(t * np.pi / 2)
    coarse, fine = (
        sum(wi * phantom.section(zi, k)[0].signed_area for zi, wi in zip(z, w, strict=True))
        for k in (200, 400)
    )
    assert (4 * fine - coarse) / 3 == pytest.approx(phantom.volume, rel=1e-7)


@pytest.mark.parametrize("name", phantoms.SOLID)
def test_section_areas_of_posed_bodies_add_up_to_the_volume(name):
    """A(z) has kinks where edges, waists and dimples begin and end: the midpoint rule over many sections."""
    phantom = phantoms.make(name, rotation=8, offset=OFFSET)
    areas = [sum(loop.signed_area for loop in phantom.section(z, 400)) for z in phantom.positions(100)]
    assert np.mean(areas) * phantom.height == pytest.approx(phantom.volume, rel=5e-4)


@pytest.mark.parametrize("name", phantoms.SOLID)
def test_in_its_own_pose_every_section_is_one_filled_loop(name):
    phantom = phantoms.make(name, offset=OFFSET)
    for section in phantom.contour_stack(41, points=60).sections:
        assert [loop.hole for loop in section.loops] == [False]


def test_apple_across_its_axis_has_rings():
    """Turned so that its axis is z, the outermost sections cut the dimple: a loop and a hole."""
    apple = phantoms.make("apple", rotation=(90, 0, 0))
    low, high = apple.extent()
    outer, hole = apple.section(high - 0.01 * (high - low))
    assert (outer.hole, hole.hole) == (False, True)
    assert outer.signed_area > 0 > hole.signed_area
    assert contains(outer.points, hole.points[0])


@pytest.mark.parametrize("seed", range(12))
def test_posed_apples_potatoes_and_bananas_have_ordered_ends(seed):
    for name in ("apple", "potato", "banana", "ellipsoid"):
        phantom = phantoms.make(name, rotation=seed, offset=OFFSET)
        assert phantom.end_kinds == ("round", "round")


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("box", ("face", "face")),
        ("cone", ("face", "point")),
        ("double-cone", ("point", "point")),
        ("meat", ("face", "round")),
        ("cylinder", ("face", "face")),
        ("superellipsoid", ("round", "round")),
    ],
)
def test_kinds_of_end(name, kinds):
    phantom = phantoms.make(name, offset=OFFSET)
    assert phantom.end_kinds == kinds
    assert phantom.posed((180, 0, 0)).end_kinds == kinds[::-1]


def test_extent_of_a_posed_ellipsoid():
    """Support function of an ellipsoid: √(dᵀ·diag(a², b², c²)·d)."""
    phantom = phantoms.make("ellipsoid", a=30, b=20, c=10, rotation=4, offset=OFFSET)
    reach = np.sqrt(np.sum((phantom.rotation[2] * [30, 20, 10]) ** 2))
    assert phantom.extent() == pytest.approx((OFFSET[2] - reach, OFFSET[2] + reach), abs=1e-11)


def test_extent_of_a_posed_superellipsoid():
    """Its support function is the dual norm: exponents q = p/(p−1)."""
    phantom = phantoms.make("superellipsoid", a=30, b=20, c=10, p=4, n=4, rotation=4)
    reach = np.sum(np.abs(phantom.rotation[2] * [30, 20, 10]) ** (4 / 3)) ** (3 / 4)
    assert phantom.extent()[1] == pytest.approx(reach, rel=1e-12)


@given(seed=st.integers(0, 10**6), t=st.floats(0.02, 0.98))
@settings(max_examples=25, deadline=None)
def test_box_sections_are_exact_vertices(seed, t):
    """Each vertex lies on an edge of the box, to rounding; Euler: all are corners."""
    phantom = phantoms.make("box", a=7, b=5, c=3, rotation=seed)
    low, high = phantom.extent()
    z = low + t * (high - low)
    (loop,) = phantom.section(z)
    own = np.abs(phantom.rotation.T @ np.column_stack([loop.points, np.full(len(loop.points), z)]).T)
    excess = own - np.array([[3.5], [2.5], [1.5]])
    assert len(loop.corners) == len(loop.points)
    assert (np.sort(np.abs(excess), axis=0)[1] < 1e-12).all()
    assert excess.max() < 1e-12


def test_a_tilted_cylinder_has_its_ellipse_and_two_corners():
    phantom = phantoms.make("cylinder", radius=10, height=20, rotation=(60, 0, 0))
    _, high = phantom.extent()
    (loop,) = phantom.section(high - 4.0, points=300)
    assert len(loop.corners) == 2
    own = phantom.rotation.T @ np.column_stack([loop.points, np.full(len(loop.points), high - 4.0)]).T
    rim = own[:, loop.corners]
    assert np.abs(np.abs(rim[2]) - 10).max() < 1e-12
    assert np.abs(np.hypot(rim[0], rim[1]) - 10).max() < 1e-12


def test_end_faces_are_sections():
    box = phantoms.make("box", a=4, b=6, c=8, rotation=(0, 0, 33), offset=OFFSET)
    stack = box.contour_stack(5, "faces")
    assert [section.z - OFFSET[2] for section in stack.sections] == pytest.approx([-4, -2, 0, 2, 4])
    assert [section.loops[0].signed_area for section in stack.sections] == pytest.approx(
        [24.0] * 5, rel=1e-13
    )
    meat = phantoms.make("meat")
    assert meat.contour_stack(11, "faces").positions == pytest.approx(16.0 * np.arange(11))
    (face,) = meat.section(0.0, points=500)
    (beside,) = meat.section(1e-7, points=500)
    assert face.signed_area == pytest.approx(beside.signed_area, rel=1e-6)


def test_two_lobed_turns_from_convex_to_peanut_and_back():
    phantom = phantoms.make("two-lobed", offset=OFFSET)

    def concave(loop):
        edge = np.roll(loop.points, -1, axis=0) - loop.points
        turn = edge[:, 0] * np.roll(edge[:, 1], -1) - edge[:, 1] * np.roll(edge[:, 0], -1)
        return bool((turn < 0).any())

    found = [concave(section.loops[0]) for section in phantom.contour_stack(25).sections]
    assert not found[0]
    assert not found[-1]
    assert found[12]
    assert sum(a != b for a, b in pairwise(found)) == 2
    (middle,) = phantom.section(OFFSET[2], points=2000)
    x, y = (middle.points - OFFSET[:2]).T
    assert 0.6 < y[np.abs(x) < 0.5].max() / y.max() < 0.7
    angles = np.unwrap(np.arctan2(y, x))
    assert (np.diff(angles) > 0).all()


@pytest.mark.parametrize("z", [-50.0, 50.0])
def test_a_plane_beside_the_body_is_refused(z):
    with pytest.raises(UsageError, match="no such section"):
        phantoms.make("ellipsoid").section(z)


def test_a_touching_plane_is_refused():
    phantom = phantoms.make("ellipsoid")
    with pytest.raises(UsageError, match="touches"):
        phantom.section(phantom.extent()[1])


@pytest.mark.parametrize("share", [1e-3, 1e-5, 1e-7])
def test_shallow_caps_are_found(share):
    """A cap of height h of an ellipsoid: A = π·ab·(1 − (1 − h/c)²)."""
    phantom = phantoms.make("ellipsoid", a=30, b=20, c=40, offset=OFFSET)
    h = share * 80
    (loop,) = phantom.section(phantom.extent()[1] - h, points=400)
    assert loop.signed_area == pytest.approx(np.pi * 600 * (1 - (1 - h / 40) ** 2), rel=1e-3)


@pytest.mark.parametrize(
    ("name", "parameters", "message"),
    [
        ("elipsoid", {}, "did you mean ellipsoid"),
        ("box", {"d": 3}, "unknown parameter"),
        ("box", {"a": -3}, "positive"),
        ("superellipsoid", {"p": 0.5}, "exponents"),
        ("potato", {"bumps": 0.9}, "range"),
        ("box", {"rotation": np.diag([1, 1, -1])}, "mirror"),
        ("box", {"rotation": np.eye(2)}, "not a rotation"),
        ("box", {"offset": (1, 2)}, "not an offset"),
    ],
)
def test_wrong_requests_are_refused(name, parameters, message):
    with pytest.raises(UsageError, match=message):
        phantoms.make(name, **parameters)


@pytest.mark.parametrize(("count", "placing"), [(1, "mid"), (5, "middle"), (5, [2.0, 1.0]), (5, "faces")])
def test_impossible_placings_are_refused(count, placing):
    with pytest.raises(UsageError):
        phantoms.make("ellipsoid").contour_stack(count, placing)
