"""Classes of grey levels, holders taken out, brightness evened out: on scans whose answers are exact."""

import numpy as np
import pytest

import stackloft
from stackloft.model.errors import InputError, UsageError
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.testing import phantoms
from stackloft_plugins.segmenters.histogram import HistogramSegmenter

AIR, FLESH, CORE = -1000.0, 40.0, 700.0


def stack_of(slices, grid):
    return SliceStack(
        lambda k: slices[k],
        tuple(f"s{k}" for k in range(len(slices))),
        grid.shape,
        grid.positions,
        np.tile(grid.spacing, (len(slices), 1)),
        SectionKind.SLAB,
        thickness=np.full(len(slices), grid.thickness),
    )


def covered(body, scanner):
    """How much of each voxel a body fills, and the grid."""
    volume = scanner.volume(body)
    air, flesh = scanner.levels
    return (np.stack(volume.slices) - air) / (flesh - air), volume.grid


def measured(stack, **options):
    body = stackloft.measure(stack, "partial-volume,loft", **options)
    return body, [row.volume.value for row in body.objects[0].methods.values()]


@pytest.fixture(scope="module")
def stone_fruit():
    """Flesh with a stone in it: volumes of both, and the scan."""
    flesh, stone = (phantoms.make("ellipsoid", a=2 * k, b=1.7 * k, c=2.2 * k) for k in (12, 6))
    low, high = flesh.extent()
    z = tuple(np.linspace(low - 3, high + 3, 24).tolist())
    scanner = phantoms.Scans(form="dicom", positions=z, pixel_size=0.8)
    whole, grid = covered(flesh, scanner)
    inner = np.stack([grid.slab(stone, float(height), 6) for height in grid.positions])
    grey = AIR + (FLESH - AIR) * whole + (CORE - FLESH) * inner
    return flesh.volume, stone.volume, stack_of(np.round(grey).astype(np.int16), grid)


def test_a_class_of_several_is_one_tissue(stone_fruit):
    whole, stone, stack = stone_fruit
    _, found = measured(stack, classes=3, settings={"segmenter": {"class": 3}})
    assert found == pytest.approx([stone, stone], rel=0.04)
    _, found = measured(stack, classes=2, settings={"segmenter": {"class": 2}})
    assert found == pytest.approx([whole, whole], rel=0.02)
    body = stackloft.measure(stack, "voxel", classes=3, class_=2, voids="keep")
    assert body.objects[0].volume.value == pytest.approx(whole - stone, rel=0.03)


def test_a_window_is_one_tissue_too(stone_fruit):
    whole, stone, stack = stone_fruit
    body = stackloft.measure(stack, "voxel", window=(-480, 370), voids="keep")
    assert body.objects[0].volume.value == pytest.approx(whole - stone, rel=0.02)


def test_classes_without_a_choice_are_listed(stone_fruit):
    stack = stone_fruit[2]
    with pytest.raises(UsageError, match=r"which class is the body\?.*1: -inf to .*3: .* to inf"):
        HistogramSegmenter(classes=3).segment(stack)
    with pytest.raises(UsageError, match="no such class; found: 4"):
        HistogramSegmenter(classes=3, class_=4).segment(stack)
    flat = np.zeros(stack.shape, np.int16)
    blank = SliceStack(
        lambda k: flat, stack.names, stack.shape, stack.positions, stack.pixel_spacing, stack.kind
    )
    with pytest.raises(InputError, match="cannot be told into 3 classes; found: 1 grey levels"):
        HistogramSegmenter(classes=3, class_=1).segment(blank)


def test_the_sample_that_a_level_is_found_from_is_told_and_decoded_alone(stone_fruit):
    stack = stone_fruit[2]
    for method in ("otsu", "half-way"):
        told = HistogramSegmenter(method=method, sample=5).segment(stack).stack.provenance["grey level"]
        assert told.endswith(f"{method} from 5 of 24 slices")


PLATE = 3.5  # mm


@pytest.fixture(scope="module")
def on_a_table():
    """A potato that lies on a table wider than itself: the potato, its scan, and the same without table."""
    potato = phantoms.make("potato", seed=3)
    scanner = phantoms.Scans(form="dicom", sections=20, empty=3, pixel_size=1.2, margin=12.0, slab_points=3)
    share, grid = covered(potato, scanner)
    lowest = max(
        potato.section(float(z))[0].points[:, 1].max()
        for z in grid.positions
        if potato.extent()[0] < z < potato.extent()[1]
    )
    side = grid.spacing[0]
    depth = grid.origin[1] + side * np.arange(grid.shape[0]) - (lowest - 0.3)
    plate = np.clip(0.5 + np.minimum(depth, PLATE - depth) / side, 0, 1)
    table = np.zeros_like(share)
    table[:, :, 3:-3] = plate[:, None]
    grey = AIR + (FLESH - AIR) * np.minimum(share + 0.9 * table, 1.0)
    return potato, stack_of(grey, grid), stack_of(AIR + (FLESH - AIR) * share, grid)


def test_a_table_is_taken_out_and_its_guest_stays_whole(on_a_table):
    potato, scan, alone = on_a_table
    result, found = measured(scan, holder="remove")
    _, clean = measured(alone)
    assert found == pytest.approx(clean, rel=2e-3)
    assert found == pytest.approx([potato.volume] * 2, rel=6e-3)
    (told,) = [notice.message for notice in result.warnings if notice.code == "holder-removed"]
    assert "taken out" in told
    assert stackloft.measure(scan, "voxel").objects[0].volume.value > 1.05 * potato.volume


def test_noise_does_not_bring_a_table_back(on_a_table):
    potato, scan, _ = on_a_table
    rng = np.random.default_rng(4)
    noisy = [scan.decode(k) + rng.normal(0, 25, scan.shape) for k in range(len(scan))]
    stack = SliceStack(
        lambda k: noisy[k],
        scan.names,
        scan.shape,
        scan.positions,
        scan.pixel_spacing,
        scan.kind,
        scan.thickness,
    )
    _, found = measured(stack, holder="remove")
    assert found == pytest.approx([potato.volume] * 2, rel=0.01)


def test_a_body_through_the_whole_scan_is_no_holder(on_a_table):
    _, _, alone = on_a_table
    middle = [alone.decode(k) for k in range(10, 20)]
    stack = SliceStack(
        lambda k: middle[k],
        alone.names[:10],
        alone.shape,
        alone.positions[:10],
        alone.pixel_spacing[:10],
        alone.kind,
    )
    with pytest.raises(InputError, match="too thick for a holder"):
        HistogramSegmenter(holder="remove").segment(stack)


def test_nothing_to_remove_is_told(on_a_table):
    result, _ = measured(on_a_table[2], holder="remove")
    assert "no-holder" in [notice.code for notice in result.warnings]


@pytest.mark.parametrize("noise", [0.0, 15.0])
def test_uneven_brightness_is_evened_out(noise):
    body = phantoms.make("potato", seed=5)
    scanner = {
        "form": "dicom",
        "sections": 14,
        "pixel_size": 1.5,
        "slab_points": 3,
        "levels": (0.0, 900.0),
        "empty": 1,
    }
    even = phantoms.Scans(**scanner, noise=noise).volume(body)
    uneven = phantoms.Scans(**scanner, bias=0.7, noise=noise).volume(body)
    truth, plain, corrected = (
        measured(stack_of(volume.slices, volume.grid), **options)[1][0]
        for volume, options in ((even, {}), (uneven, {}), (uneven, {"bias_field": "n4"}))
    )
    assert abs(plain / truth - 1) > 2 * abs(corrected / truth - 1)
    assert corrected == pytest.approx(truth, rel=0.003)
