"""Counting voxels and summing coverage: what they know, and which way they err."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stackloft.model.errors import InputError
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind
from stackloft.testing import phantoms
from stackloft.testing.phantoms.pose import rotation_matrix
from stackloft.testing.voxel_bodies import ellipsoid_coverage, ellipsoid_mask, voxel_body
from stackloft_plugins.integrators.partial_volume import PartialVolume
from stackloft_plugins.integrators.polyhedral import Polyhedral
from stackloft_plugins.integrators.voxel import Voxel
from stackloft_plugins.reconstructors.isosurface import Isosurface

IBSI = Path(__file__).parents[3] / "shared" / "real" / "ibsi_digital" / "nifti" / "mask" / "mask.nii.gz"
AXES = (14.0, 10.0, 8.0)
EXACT = phantoms.make("ellipsoid", a=14, b=10, c=8).volume


def scanned(spacing, seed, **more):
    phase = np.random.default_rng(seed).uniform(-0.5, 0.5, 3)
    return voxel_body(
        ellipsoid_coverage(AXES, rotation_matrix(seed), spacing, phase), spacing, labels=False, **more
    )


def replaced(body, **changes):
    return replace(body, stack=replace(body.stack, **changes))


def test_voxels_are_counted_times_their_size():
    mask = np.zeros((3, 4, 5), bool)
    mask[1, 1:3, 2:5] = mask[2, 0, 0] = True
    found = Voxel().integrate(voxel_body(mask, (0.5, 0.4, 2.0), labels=True))
    assert found.volume == pytest.approx(7 * 0.5 * 0.4 * 2.0, rel=1e-12)
    assert found.area is None


def test_every_slice_counts_with_its_own_length_and_pixels():
    body = voxel_body(np.ones((3, 4, 5), bool), (1.0, 1.0, 1.0), labels=True)
    sizes = np.array([[1.0, 1.0], [0.5, 1.0], [2.0, 2.0]])
    body = replaced(body, positions=np.array([0.0, 1.0, 4.0]), pixel_spacing=sizes)
    assert Voxel().integrate(body).volume == pytest.approx(20 * (1 * 1 + 2 * 0.5 + 3 * 4), rel=1e-12)


def test_a_single_slice_is_as_thick_as_it_says_and_else_refused():
    body = voxel_body(np.ones((1, 4, 5), bool), (1.0, 1.0, 3.0), labels=True)
    assert Voxel().integrate(body).volume == pytest.approx(60.0)
    with pytest.raises(InputError, match="no thickness"):
        Voxel().integrate(replaced(body, thickness=None))


@pytest.mark.parametrize("spacing", [(0.5, 0.5, 0.5), (0.4, 0.6, 1.5), (0.5, 0.5, 4.0)])
def test_coverage_is_unbiased_at_any_voxel_size(spacing):
    errors = [PartialVolume().integrate(scanned(spacing, seed)).volume / EXACT - 1 for seed in range(5)]
    assert np.abs(errors).max() < 0.002


def test_slabs_less_than_half_full_count_too():
    # five slabs, of which the outermost hold 0.3 and 0.2 of the body's thickness
    covered = np.zeros((7, 40, 40))
    covered[1:6, 10:30, 10:30] = np.array([0.3, 1.0, 1.0, 1.0, 0.2])[:, None, None]
    body = voxel_body(covered, (1.0, 1.0, 5.0), labels=False)
    assert PartialVolume().integrate(body).volume == pytest.approx(400 * 5 * 3.5, rel=1e-9)
    assert Voxel().integrate(body).volume == pytest.approx(400 * 5 * 3, rel=1e-9)


def test_coverage_does_not_depend_on_contrast_or_on_the_level():
    body = scanned((0.5, 0.5, 1.5), 3)
    one = PartialVolume().integrate(body).volume
    dark = replace(body, field_of=lambda _, x: SectionField(7.0 + 0.02 * x, 7.0 + 0.02 * 62.0))
    assert PartialVolume().integrate(dark).volume == pytest.approx(one, rel=2e-3)
    high = replace(body, field_of=lambda _, x: SectionField(x, 62.0))
    assert abs(Voxel().integrate(high).volume / EXACT - 1) > 0.005


def test_between_photographs_slices_do_not_blur_into_each_other():
    covered = np.zeros((3, 40, 40))
    for plane, half in zip(covered, (6.3, 10.4, 8.2), strict=True):
        reach = np.clip(half + 0.5 - np.abs(np.arange(40) - 19.7), 0, 1)
        plane[:] = reach[:, None] * reach[None, :]
    body = voxel_body(covered, (1.0, 1.0, 5.0), labels=False, kind=SectionKind.FACE)
    assert PartialVolume().integrate(body).volume == pytest.approx(covered.sum() * 5, rel=1e-9)


def test_crumbs_and_glare_count_on_grey_slices_as_they_do_for_contours():
    grey = np.zeros((2, 40, 40))
    grey[:, 5:25, 5:25], grey[:, 12, 12], grey[:, 32:34, 32:34] = 1.0, 0.4, 1.0
    assert Voxel().integrate(voxel_body(grey, (1, 1, 1), labels=False)).volume == 800
    labels = voxel_body(grey > 0.5, (1, 1, 1), labels=True)
    assert Voxel().integrate(labels).volume == 2 * (400 - 1 + 4)


def test_a_label_maps_coverage_is_the_sum_of_its_voxels():
    mask = ellipsoid_mask(AXES, np.eye(3), (1, 2, 3))
    body = voxel_body(mask, (1, 2, 3), labels=True)
    assert PartialVolume().integrate(body).volume == pytest.approx(6.0 * mask.sum(), rel=1e-12)


def test_a_body_without_a_whole_pixel_is_refused():
    thin = np.zeros((3, 40, 40))
    thin[:, 20:22, 10:30] = 1.0
    with pytest.raises(InputError, match="no pixel lies wholly inside"):
        PartialVolume().integrate(voxel_body(thin, (1, 1, 1), labels=False))


def test_the_outer_slabs_are_what_may_be_wrong():
    found = Voxel().integrate(voxel_body(np.ones((5, 4, 4), bool), (1.0, 1.0, 2.0), labels=True))
    assert (found.volume_bias.low, found.volume_bias.high) == pytest.approx((-20.0, 20.0))


@pytest.mark.skipif(not IBSI.exists(), reason="the IBSI digital phantom is not at hand")
def test_the_ibsi_digital_phantom():
    sitk = pytest.importorskip("SimpleITK")
    image = sitk.ReadImage(str(IBSI))
    body = voxel_body(sitk.GetArrayFromImage(image) > 0, image.GetSpacing(), labels=True)
    assert Voxel().integrate(body).volume == pytest.approx(592.0, rel=1e-6)
    mesh = Polyhedral().integrate(Isosurface().reconstruct(body))
    assert mesh.volume == pytest.approx(556, abs=4)
    assert mesh.area == pytest.approx(388, abs=3)


def test_a_segmentation_without_slices_of_body_is_refused():
    empty = voxel_body(np.zeros((4, 9, 9)), (1, 1, 1), labels=False)
    assert isinstance(empty, Segmentation)
    for plugin in (Voxel(), PartialVolume()):
        with pytest.raises(InputError):
            plugin.integrate(empty)


def with_skin(brighter, thick):
    """Return an ellipsoid whose skin is so much brighter than the flesh below it, and as thick, mm."""
    spacing = (0.5, 0.5, 0.5)
    flesh = ellipsoid_coverage(np.array(AXES) - thick, np.eye(3), spacing)
    whole = ellipsoid_coverage(AXES, np.eye(3), spacing)
    rims = [((a - b) // 2, a - b - (a - b) // 2) for a, b in zip(whole.shape, flesh.shape, strict=True)]
    return voxel_body(whole + brighter * (whole - np.pad(flesh, rims)), spacing, labels=False)


def test_a_skin_that_outshines_the_flesh_is_refused():
    with pytest.raises(InputError, match="brighter at its edge"):
        PartialVolume().integrate(with_skin(1.2, 1.5))


def test_a_skin_a_little_brighter_costs_its_thickness_times_the_difference():
    brighter, thick = 0.2, 0.25
    found = PartialVolume().integrate(with_skin(brighter, thick)).volume
    skin = EXACT - phantoms.make("ellipsoid", **dict(zip("abc", np.array(AXES) - thick, strict=True))).volume
    assert found == pytest.approx(EXACT + brighter * skin, rel=2e-3)
