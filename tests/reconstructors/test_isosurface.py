"""The level's surface: closed, where the slices are, and as far off as it says."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from stackloft.geometry.closed_mesh import unmatched_edges
from stackloft.model.errors import InputError
from stackloft.testing import phantoms
from stackloft.testing.phantoms.pose import rotation_matrix
from stackloft.testing.voxel_bodies import ellipsoid_coverage, ellipsoid_mask, voxel_body
from stackloft_plugins.integrators.polyhedral import Polyhedral
from stackloft_plugins.reconstructors.isosurface import Isosurface

SHAPES = {"ball": (40.0, 40.0, 40.0), "spheroid": (60.0, 45.0, 40.0), "slab": (80.0, 48.0, 40.0)}


def errors(body, axes):
    exact = phantoms.make("ellipsoid", a=axes[0], b=axes[1], c=axes[2])
    found = Polyhedral().integrate(Isosurface().reconstruct(body))
    return (np.array([found.volume, found.area]) / [exact.volume, exact.area] - 1) * 100


def grey(axes, seed, blur=0.0, spacing=(1.0, 1.0, 1.0)):
    covered = ellipsoid_coverage(
        axes, rotation_matrix(seed), spacing, np.random.default_rng(seed).uniform(-0.5, 0.5, 3)
    )
    covered = np.round(200 * np.pad(covered, 3)) / 200  # as 8-bit pictures hold it
    return voxel_body(gaussian_filter(covered, blur) if blur else covered, spacing, labels=False)


@pytest.mark.parametrize("blur", [0.0, 0.7])
def test_grey_phantoms_of_forty_voxels(blur):
    volume, area = errors(grey(SHAPES["ball"], 1, blur), SHAPES["ball"])
    assert abs(volume) <= 0.2
    assert abs(area) <= 0.5


@pytest.mark.prove
def test_grey_phantoms_and_label_maps_in_many_poses(proof):
    rows = []
    for shape, axes in SHAPES.items():
        for name, blur in (("coverage", 0.0), ("coverage, blurred by 0.7 voxels", 0.7), ("label map", None)):
            found = []
            for seed in range(10):
                phase = np.random.default_rng(seed).uniform(-0.5, 0.5, 3)
                if blur is None:
                    mask = ellipsoid_mask(axes, rotation_matrix(seed), (1, 1, 1), phase)
                    found.append(errors(voxel_body(mask, (1, 1, 1), labels=True), axes))
                else:
                    found.append(errors(grey(axes, seed, blur), axes))
            mean, worst = np.mean(found, axis=0), np.abs(found).max(axis=0)
            rows.append((shape, name, *(f"{m:+.3f} ({w:.3f})" for m, w in zip(mean, worst, strict=True))))
            if blur is not None:
                assert worst[0] <= 0.2
                assert worst[1] <= 0.5
    proof(
        "isosurface",
        "Isosurface of ellipsoids at 40 voxels in the thinnest semi-axis, 10 poses: mean error (worst), %",
        ("body", "voxels", "V", "S"),
        rows,
    )


@pytest.mark.parametrize("ratio", [1.0, 3.0, 10.0])
def test_a_label_map_errs_as_it_is_marked_to(ratio):
    axes = np.array([1.0, 0.6, 0.5]) * 20 * ratio if ratio > 1 else np.array([40.0, 24.0, 20.0])
    spacing = (1.0, 1.0, ratio)
    for seed in (2, 7):
        mask = ellipsoid_mask(axes, rotation_matrix(seed), spacing, (0.2, 0.3, 0.1))
        mesh = Isosurface().reconstruct(voxel_body(mask, spacing, labels=True))
        found = Polyhedral().integrate(mesh)
        exact = phantoms.make("ellipsoid", a=axes[0], b=axes[1], c=axes[2])
        assert "stair-stepped" in mesh.biased
        assert found.area_bias.low < (found.area / exact.area - 1) * 100 < found.area_bias.high
        assert abs(found.volume / exact.volume - 1) < 0.01


def test_uneven_slices_pixel_sizes_origins_and_shear_are_honoured():
    # a plane field in bench space: whatever the lattice, the surface is the plane
    body = grey((10.0, 8.0, 7.0), 4)
    m = len(body)
    rng = np.random.default_rng(1)
    affine = np.eye(4)
    affine[:3, :3] = rotation_matrix(2) @ [[1, 0, 0.4], [0, 1, -0.2], [0, 0, 1]]
    stack = replace(
        body.stack,
        positions=np.cumsum(rng.uniform(0.5, 1.5, m)),
        pixel_spacing=rng.uniform(0.8, 1.2, (m, 2)),
        origins=rng.uniform(-3, 3, (m, 2)),
        affine=affine,
    )
    low = stack.origins.max(axis=0) + 2
    high = (stack.origins + stack.pixel_spacing[:, ::-1] * (np.array(stack.shape[::-1]) - 1)).min(axis=0) - 2
    normal = np.array([0.3, -0.5, 0.8])
    shift = float(normal @ affine[:3, :3] @ [*(low + high) / 2, stack.positions.mean()])
    rows, columns = np.mgrid[: stack.shape[0], : stack.shape[1]]

    def field_of(k, _):
        (dy, dx), (x0, y0) = stack.pixel_spacing[k], stack.origins[k]
        own = np.stack([x0 + columns * dx, y0 + rows * dy, np.full(stack.shape, stack.positions[k])])
        bench = np.tensordot(affine[:3, :3], own, axes=1)
        return replace(
            body.field_of(k, body.stack.decode(k)), values=shift - np.tensordot(normal, bench, 1), level=0.0
        )

    mesh = Isosurface().reconstruct(replace(body, stack=stack, field_of=field_of, binary=True))
    assert unmatched_edges(mesh.faces) == 0
    assert Polyhedral().integrate(mesh).volume > 0
    own = mesh.vertices @ np.linalg.inv(affine[:3, :3]).T
    ends = stack.positions[[0, -1]] + [0.01, -0.01]
    seen = (
        ((own[:, :2] > low) & (own[:, :2] < high)).all(axis=1) & (own[:, 2] > ends[0]) & (own[:, 2] < ends[1])
    )
    assert seen.sum() > 50  # where every slice was seen, the surface is the plane and nothing else
    assert np.abs(mesh.vertices[seen] @ normal - shift).max() < 1e-4


def test_a_mirrored_scanner_does_not_turn_the_body_inside_out():
    body = grey((10.0, 8.0, 7.0), 4)
    flipped = replace(body, stack=replace(body.stack, affine=np.diag([-1.0, 1.0, 1.0, 1.0])))
    one, other = (Polyhedral().integrate(Isosurface().reconstruct(x)) for x in (body, flipped))
    assert other.volume == pytest.approx(one.volume, rel=1e-9)


def test_a_body_that_is_cut_off_is_closed_half_a_step_beyond():
    body = voxel_body(np.ones((4, 6, 8)), (1.0, 1.0, 3.0), labels=True)
    body = replace(body, field_of=lambda k, x: replace_values(x[4:-4, 4:-4]))
    body = replace(body, stack=replace(body.stack, shape=(6, 8)))
    found = Polyhedral().integrate(Isosurface().reconstruct(body))
    # chamfered by half a voxel's corners and edges, otherwise the whole block
    assert 0.85 * 4 * 6 * 8 * 3 < found.volume < 4 * 6 * 8 * 3


def replace_values(values):
    from stackloft.model.segmentation import SectionField  # noqa: PLC0415

    return SectionField(values, 50.0)


def test_levels_that_equal_the_data_do_not_open_the_surface():
    values = np.zeros((5, 9, 9))
    values[1:4, 2:7, 2:7] = 0.5
    values[2, 3:6, 3:6] = 1.0
    mesh = Isosurface().reconstruct(voxel_body(values, (1, 1, 1), labels=False))
    assert unmatched_edges(mesh.faces) == 0
    assert Polyhedral().integrate(mesh).volume > 0


def test_nothing_and_too_much_are_refused():
    with pytest.raises(InputError, match="there is no body"):
        Isosurface().reconstruct(voxel_body(np.zeros((4, 9, 9)), (1, 1, 1), labels=False))
    with pytest.raises(InputError, match=r"at most 0\.001 MB"):
        Isosurface(memory=1e-3).reconstruct(voxel_body(np.ones((4, 9, 9)), (1, 1, 1), labels=False))
