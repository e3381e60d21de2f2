"""The compiled kernels give what NumPy and OpenCV give, on seeded slices of every kind."""

import cv2
import numpy as np
import pytest

from stackloft.compiled.coverage import Rings
from stackloft.compiled.library import kernels, without_kernels
from stackloft.compiled.smooth_curve import smooth_closed
from stackloft.compiled.solid_piece import solid_pieces
from stackloft.geometry.noise_floor import NoiseFloor
from stackloft.model.contour_stack import Loop
from stackloft.model.segmentation import SectionField
from stackloft.sectioning import voids
from stackloft.sectioning.single_outline import single_outlines
from stackloft.sectioning.slice_lines import SliceToTrace, TraceRules
from stackloft.sectioning.slice_pieces import body_pieces, single_piece
from stackloft.sectioning.smoothing import smooth_loop
from stackloft.sectioning.traced_corners import CornerRules
from stackloft.sectioning.tracing import trace_fields
from stackloft.sectioning.turning_loops import may_turn
from stackloft.sectioning.voids import CRACKS
from stackloft_plugins.integrators.edge_zone import Neighboured, edge_zones
from stackloft_plugins.integrators.seen_slice import SeenSlice
from stackloft_plugins.segmenters.slab_level import _DEEP, _slice_bands

pytestmark = pytest.mark.skipif(kernels() is None, reason="no compiled kernels here")
SLICES = 800
KINDS = ("int16", "uint8", "uint16", "int32", "int8", "float32", "float64")
LEVELS = (60.0, 59.5, 63.3)


def random_slice(rng):
    """Return grey levels of a random body, and a level; a third are jagged, some reach the border."""
    shape = rng.integers(5, 150, 2)
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    texture = cv2.GaussianBlur(rng.normal(size=shape).astype(np.float32), (0, 0), rng.uniform(0.5, 12.0))
    size = rng.uniform(1.7, 3.0)
    away = np.hypot(rows / shape[0] - 0.5, columns / shape[1] - 0.5) * size
    field = (1.0 - away) * rng.uniform(2.0, 12.0) + texture / texture.std() * rng.choice([0.0, 0.3, 1.0])
    grey = (20.0 * field + 60.0).clip(0.0, 127.0).astype(rng.choice(KINDS))
    if rng.random() < 0.3:  # a window of a larger picture
        wide = np.zeros((shape[0] + 7, shape[1] + 9), grey.dtype)
        wide[3 : 3 + shape[0], 4 : 4 + shape[1]] = grey
        grey = wide[3 : 3 + shape[0], 4 : 4 + shape[1]]
    return grey, float(rng.choice(LEVELS))


def random_noise(rng):
    """Return what noise adds to empty pixels, or nothing."""
    return NoiseFloor(40.0, 7.0) if rng.random() < 0.5 else None


def random_loop(rng):
    """Return the vertices of a closed loop, some with corners or at uneven steps, and its pixel size."""
    count = int(rng.integers(12, 900))
    t = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    if rng.random() < 0.3:
        t = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
    wave = sum(rng.normal() * 0.05 / m * np.cos(m * t + rng.uniform(0.0, 6.0)) for m in range(1, 7))
    radius = count / 6.0 * (1.0 + wave)
    if rng.random() < 0.4:
        radius = np.minimum(radius, 0.15 * count / np.cos(t % (0.5 * np.pi) - 0.25 * np.pi))
    points = np.column_stack([radius * np.cos(t), radius * np.sin(t)])
    points += rng.normal(size=points.shape) * rng.choice([0.0, 0.02, 0.2])
    pixel = float(rng.choice([1.0, 0.3]))
    return points * pixel, pixel


def test_one_piece_is_found_where_opencv_finds_one_and_nowhere_else():
    rng, one, others = np.random.default_rng(1), 0, 0
    for _ in range(SLICES):
        grey, level = random_slice(rng)
        body = np.ascontiguousarray(grey > level)
        chains, (found,) = single_piece(body.view(np.uint8)), solid_pieces([(grey, level)], CRACKS)
        assert (found is not None) == (len(chains) == 1)
        if found is None:
            others += 1
            continue
        one += 1
        pieces = body_pieces(body)
        assert np.array_equal(found.outline, chains[0])
        assert found.corner == pieces.corner
        assert found.shape == pieces.pieces.shape
        assert found.pixels == pieces.sizes[0]
    assert min(one, others) > SLICES // 20  # else this says nothing


def test_background_is_closed_in_where_the_disc_closes_it():
    rng, answers = np.random.default_rng(2), {True: 0, False: 0}
    for _ in range(SLICES):
        grey, level = random_slice(rng)
        if rng.random() < 0.7:  # a slit of one to four pixels
            row, column = rng.integers(0, grey.shape[0]), rng.integers(0, grey.shape[1])
            grey[row : row + rng.integers(1, 5), column:] = 0
        framed = np.pad(grey, CRACKS.frame)
        (found,) = solid_pieces([(framed, level)], CRACKS)
        if found is None:
            continue
        body = framed > level
        assert found.open == voids._surely_open(body.view(np.uint8), solid=True, apart=True)
        assert not found.open or voids.closed_background(body) is None
        answers[found.open] += 1
    assert min(answers.values()) > 10


def test_traced_outlines_are_the_same_points():
    rng, traced = np.random.default_rng(3), 0
    for _ in range(SLICES):
        grey, level = random_slice(rng)
        (solid,) = solid_pieces([(grey, level)], CRACKS)
        if solid is None:
            continue
        outline = solid.outline + np.array([4, 3], np.int32)
        section = SectionField(grey, level, (3, 4), noise=random_noise(rng), outline=outline)
        one = SliceToTrace(section, (0.5, 0.7), (grey.shape[0] + 9, grey.shape[1] + 9), "a")
        (points,) = single_outlines([one], TraceRules())
        if points is None:
            continue
        traced += 1
        with without_kernels():
            reference = trace_fields([one], TraceRules())[0]
        assert len(reference.loops) == 1
        assert reference.at_border == (False,)
        assert not reference.perhaps
        np.testing.assert_allclose(points, reference.loops[0].points, rtol=0.0, atol=1e-10)
    assert traced > SLICES // 3


def test_bands_beside_the_boundary_hold_the_same_grey():
    rng, seen = np.random.default_rng(6), 0
    for _ in range(SLICES // 4):
        grey, level = random_slice(rng)
        found = _slice_bands(grey, level, 1.0, _DEEP)
        with without_kernels():
            reference = _slice_bands(grey, level, 1.0, _DEEP)
        for own, other in zip(found, reference, strict=True):
            assert own.dtype == other.dtype
            assert np.array_equal(own, other)
        seen += bool(found[0].size and found[1].size)
    assert seen > SLICES // 16


def test_smoothed_loops_and_corners_are_the_same():
    rng, compiled, turning = np.random.default_rng(4), 0, []
    for _ in range(SLICES):
        points, pixel = random_loop(rng)
        loop = Loop(points)
        smooth, turns = smooth_loop(loop, pixel), may_turn([loop], [pixel], CornerRules())[0]
        with without_kernels():
            reference = smooth_loop(loop, pixel)
            turning.append(bool(may_turn([loop], [pixel], CornerRules())[0]))
        assert turns == turning[-1]
        np.testing.assert_allclose(smooth.points, reference.points, rtol=0.0, atol=1e-8 * np.ptp(points))
        compiled += smooth_closed([points], 6.0 * pixel, 1.5 * pixel, 8)[0] is not None
    assert compiled > SLICES // 2
    assert SLICES // 10 < sum(turning) < SLICES - SLICES // 10


@pytest.mark.parametrize("zone", [1, 2, 5])
@pytest.mark.parametrize("rings", [Rings(4, 1), Rings(2, 2)])
def test_edge_zones_and_rings_hold_the_same_grey(zone, rings):
    rng = np.random.default_rng(5)
    slices = []
    for number in range(SLICES // 8):
        current, before, after = (_seen(rng) for _ in range(3))
        slices.append(Neighboured(current, (None if number % 5 == 0 else before, after), rings))
    together = edge_zones(slices, zone)
    with without_kernels():
        references = edge_zones(slices, zone)
    for found, reference in zip(together, references, strict=True):
        assert (found.inside, found.edge, found.full) == (reference.inside, reference.edge, reference.full)
        for own, other in zip(found.rings, reference.rings, strict=True):
            assert np.array_equal(own, other)
        scale = 1e-12 * 256.0 * max(found.edge, 1)
        assert abs(found.grey - reference.grey) <= scale
        assert abs(found.full_grey - reference.full_grey) <= scale


def _seen(rng):
    grey, level = random_slice(rng)
    offset = tuple(int(place) for place in rng.integers(0, 90, 2))
    return SeenSlice(SectionField(grey, level, offset, noise=random_noise(rng)))


def test_levels_beyond_a_kind_of_numbers_leave_nothing_or_everything():
    grey = np.zeros((30, 70), np.int16)
    grey[10:20, 10:60] = 9
    full = SeenSlice(SectionField(grey, 8.0))
    for level in (-np.inf, -1e9, -0.5, 9.0, 1e9, np.inf, np.nan):
        one = Neighboured(SeenSlice(SectionField(grey, level)), (full, full))
        (found,) = edge_zones([one], 2)
        with without_kernels():
            (reference,) = edge_zones([one], 2)
        assert (found.inside, found.edge, found.full) == (reference.inside, reference.edge, reference.full)
