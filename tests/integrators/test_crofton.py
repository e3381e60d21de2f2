"""Crofton's area of smooth binary bodies in any pose, at the spacings that scans come in."""

import numpy as np
import pytest

from stackloft.geometry.lattice_directions import plain_directions, spaced_directions
from stackloft.geometry.set_covariance import crossings, set_covariance
from stackloft.model.errors import InputError
from stackloft.testing import phantoms
from stackloft.testing.phantoms.pose import rotation_matrix
from stackloft.testing.voxel_bodies import ellipsoid_mask, voxel_body
from stackloft_plugins.integrators.crofton import Crofton, crofton_area

SHAPES = {"ball": (1.0, 1.0, 1.0), "spindle": (1.0, 0.5, 0.5), "slab": (1.0, 0.4, 0.3)}
SPACINGS = (1, 3, 10)


def ellipsoid(shape, ratio):
    """Semi-axes in fine voxels: at least 40 of them and 12 slices across the thinnest way; and the area."""
    axes = np.array(SHAPES[shape]) / min(SHAPES[shape]) * max(20.0, 6.0 * ratio)
    return axes, phantoms.make("ellipsoid", a=axes[0], b=axes[1], c=axes[2]).area


def by_simpleitk(mask, spacing):
    sitk = pytest.importorskip("SimpleITK")
    image = sitk.GetImageFromArray(mask.astype(np.uint8))
    image.SetSpacing([float(step) for step in spacing])
    shape = sitk.LabelShapeStatisticsImageFilter()
    shape.ComputePerimeterOn()
    shape.Execute(image)
    return shape.GetPerimeter(1)


def errors(shape, ratio, poses, *, peers=True):
    """Relative errors in percent, (poses, methods): spaced, 13, 3 directions and SimpleITK's."""
    axes, exact = ellipsoid(shape, ratio)
    spacing = np.array([1.0, 1.0, float(ratio)])
    lines = [spaced_directions(np.diag(spacing)), *(plain_directions(np.diag(spacing), n) for n in (13, 3))]
    found = []
    for seed in range(poses):
        phase = np.random.default_rng(seed).uniform(-0.5, 0.5, 3)
        mask = ellipsoid_mask(axes, rotation_matrix(seed), spacing, phase)
        areas = [crofton_area(mask, np.diag(spacing), one) for one in (lines if peers else lines[:1])]
        found.append([*areas, by_simpleitk(mask, spacing)] if peers else areas)
    return (np.array(found) / exact - 1) * 100


@pytest.mark.parametrize("ratio", SPACINGS)
@pytest.mark.parametrize("shape", ["ball", "slab"])
def test_smooth_bodies_in_any_pose(shape, ratio):
    found = errors(shape, ratio, 12, peers=False)[:, 0]
    assert abs(found.mean()) <= 0.5
    assert found.std(ddof=1) <= 1.0


@pytest.mark.prove
def test_smooth_bodies_in_a_hundred_poses_with_simpleitk_beside(proof):
    rows = []
    for shape, axes in SHAPES.items():
        for ratio in SPACINGS:
            found = errors(shape, ratio, 100)
            bias, spread, worst = found.mean(axis=0), found.std(axis=0, ddof=1), np.abs(found).max(axis=0)
            assert abs(bias[0]) <= 0.5
            assert spread[0] <= 1.0
            cells = [f"{b:+.3f} ± {s:.3f} ({w:.2f})" for b, s, w in zip(bias, spread, worst, strict=True)]
            rows.append((" : ".join(map(str, axes)), f"1 : {ratio}", *cells))
    proof(
        "crofton",
        "Crofton's area of binary ellipsoids, 100 poses each, at least 40 fine voxels and 12 slices across: "
        "bias ± standard deviation (worst), %",
        ("semi-axes", "spacing", "spaced", "13 directions", "3 directions", "SimpleITK"),
        rows,
    )


def test_simpleitk_errs_where_spacing_differs_and_this_does_not():
    found = errors("slab", 3, 3)
    assert np.abs(found[:, 0]).max() < 0.3
    assert np.abs(found[:, 3]).max() > 5.0


def test_shear_changes_nothing():
    # a slanting lattice through an ellipsoid: every voxel centre asked for itself
    basis = np.array([[1.0, 0.0, 1.3], [0.0, 0.8, -0.7], [0.0, 0.0, 2.5]])
    axes = np.array([50.0, 30.0, 25.0])
    n = np.array([95, 55, 12])
    k, j, i = np.meshgrid(*(np.arange(-c, c + 1) for c in n[::-1]), indexing="ij")
    points = np.stack([i, j, k], axis=-1) @ basis.T + [0.3, 0.1, 0.4]
    mask = ((points / axes) ** 2).sum(axis=-1) < 1
    exact = phantoms.make("ellipsoid", a=50, b=30, c=25).area
    assert crofton_area(mask, basis, spaced_directions(basis)) == pytest.approx(exact, rel=3e-3)


def box_mask(sides, turn, ratio):
    half = [int(c) for c in np.ceil(np.abs(turn) @ np.array(sides) / 2 / [1, 1, ratio]) + 1]
    z, y, x = np.meshgrid(*(np.arange(-c, c + 1.0) for c in half[::-1]), indexing="ij")
    points = np.stack([x + 0.3, y + 0.2, ratio * (z + 0.4)], axis=-1) @ turn
    return (np.abs(points) < np.array(sides) / 2).all(axis=-1)


@pytest.mark.parametrize("ratio", [1, 3])
def test_sharp_edges_cost_little_unless_the_faces_lie_along_the_lattice(ratio):
    sides = np.array([40.0, 50.0, 60.0]) * max(1.0, 0.9 * ratio)
    exact = 2 * (sides[0] * sides[1] + sides[1] * sides[2] + sides[2] * sides[0])
    basis = np.diag([1.0, 1.0, float(ratio)])
    found = [
        crofton_area(box_mask(sides, turn, ratio), basis, spaced_directions(basis)) / exact - 1
        for turn in (*(rotation_matrix(k) for k in range(5)), np.eye(3))
    ]
    assert abs(np.mean(found[:5])) < 0.004
    assert -0.05 < found[5] < 0.0


def test_few_slices_are_enough_for_a_rough_figure():
    # six slices across: the third multiple of the longer steps no longer overlaps
    basis = np.diag([1.0, 1.0, 10.0])
    masks = [ellipsoid_mask((30.0,) * 3, np.eye(3), (1.0, 1.0, 10.0), (0.2, 0.4, p)) for p in (-0.4, 0, 0.3)]
    found = np.array([crofton_area(mask, basis, spaced_directions(basis)) for mask in masks])
    assert np.abs(found / (4 * np.pi * 900) - 1).max() < 0.03


@pytest.mark.parametrize("directions", ["spaced", "13", "3"])
def test_the_plug_in(directions):
    mask = ellipsoid_mask((12.0, 9.0, 8.0), rotation_matrix(5), (0.4, 0.4, 1.2))
    found = Crofton(directions=directions).integrate(voxel_body(mask, (0.4, 0.4, 1.2), labels=True))
    body = phantoms.make("ellipsoid", a=12, b=9, c=8)
    assert found.volume == pytest.approx(body.volume, rel=0.01)
    assert found.area == pytest.approx(body.area, rel={"spaced": 0.004, "13": 0.02, "3": 0.12}[directions])
    assert found.area_bias.low < (found.area / body.area - 1) * 100 < found.area_bias.high


def test_uneven_slices_form_no_lattice():
    body = voxel_body(np.ones((4, 5, 5)), (1.0, 1.0, 2.0), labels=True)
    positions = np.array([0.0, 2.0, 4.0, 7.0])
    object.__setattr__(body.stack, "positions", positions)
    with pytest.raises(InputError, match="unevenly spaced"):
        Crofton().integrate(body)


def test_nothing_and_too_much_are_refused():
    with pytest.raises(InputError, match="there is no body"):
        Crofton().integrate(voxel_body(np.zeros((4, 5, 5)), (1.0, 1.0, 2.0), labels=True))
    with pytest.raises(InputError, match="needs the whole volume"):
        Crofton(memory=1e-4).integrate(voxel_body(np.ones((9, 9, 9)), (1.0, 1.0, 2.0), labels=True))


def test_covariance_is_symmetric_and_crossings_of_a_bar_are_its_ends():
    rng = np.random.default_rng(4)
    mask = rng.random((7, 8, 9)) < 0.5
    for step in ((1, -2, 3), (0, 0, 1), (2, 1, 0)):
        assert set_covariance(mask, step) == set_covariance(mask, [-k for k in step])
    assert set_covariance(mask, (0, 0, 0)) == mask.sum()
    assert crossings(np.ones((5, 6), bool), (1, 0), 30) == 12
