"""The histogram segmenter finds the body's edge whatever the light, and says when it cannot."""

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import gaussian_filter
from skimage.filters import threshold_otsu, threshold_triangle

from stackloft.model.errors import InputError, UsageError
from stackloft.model.slice_stack import Hints, SectionKind, SliceStack
from stackloft.sectioning.contour_sink import trace_stack
from stackloft.testing.phantoms.coverage import coverage
from stackloft_plugins.segmenters.grey import grey_levels, median_filtered
from stackloft_plugins.segmenters.histogram import HistogramSegmenter
from stackloft_plugins.segmenters.histogram_levels import METHODS, grey_histogram, otsu, triangle

SHAPE = (150, 180)
AREA = np.pi * 60 * 40


def body(a=60.0, b=40.0, centre=(88.3, 74.7)):
    t = 2 * np.pi * np.arange(3000) / 3000
    return coverage([np.column_stack([a * np.cos(t), b * np.sin(t)]) + centre], SHAPE)


def photo(plate=(235, 235, 230), flesh=(180, 90, 80), covered=None, noise=0.0, blur=0.0, seed=0):
    covered = body() if covered is None else covered
    colours = np.array(plate) + (np.array(flesh) - np.array(plate)) * covered[..., None]
    colours = gaussian_filter(colours, (blur, blur, 0)) if blur else colours
    colours = colours + np.random.default_rng(seed).normal(0, noise, colours.shape) if noise else colours
    return np.clip(np.rint(colours), 0, 255).astype(np.uint8)


def stack_of(*pictures, hints=None):
    count = len(pictures)
    return SliceStack(
        lambda k: pictures[k],
        tuple(f"cut_{k + 1}.png" for k in range(count)),
        pictures[0].shape[:2],
        np.arange(count, dtype=float),
        np.ones((count, 2)),
        SectionKind.FACE,
        hints=hints or Hints(),
    )


def field(picture, number=0, hints=None, **options):
    stack = stack_of(*[picture] * (number + 1), hints=hints)
    return HistogramSegmenter(**options).segment(stack).field_of(number, picture)


def area(picture, **options):
    segmentation = HistogramSegmenter(**options).segment(stack_of(picture, picture))
    return trace_stack(segmentation).sections[0].loops[0].signed_area


@pytest.mark.parametrize("blur", [0, 0.6, 1.5])
@pytest.mark.parametrize(
    ("plate", "flesh"),
    [((235, 235, 230), (180, 90, 80)), ((20, 20, 25), (200, 190, 120)), ((90,) * 3, (140,) * 3)],
)
def test_half_way_level_places_the_boundary(plate, flesh, blur):
    """A blur of σ moves the half-way line by σ²/2R towards the centre of curvature: πσ² in all."""
    assert area(photo(plate, flesh, blur=blur)) == pytest.approx(AREA - np.pi * blur**2, rel=5e-4)


def test_the_level_is_half_way_though_otsus_may_lie_anywhere():
    picture = photo()
    luminance = [np.dot(colour, (0.299, 0.587, 0.114)) for colour in ((235, 235, 230), (180, 90, 80))]
    assert field(picture).threshold == pytest.approx(np.mean(luminance), abs=0.3)


@pytest.mark.parametrize("method", [*METHODS, "half-way"])
@pytest.mark.parametrize("seed", [1, 2])
def test_every_method_finds_a_noisy_body(method, seed):
    picture = photo(noise=4, blur=0.8, seed=seed)
    expected = {"triangle": 0.1, "minimum": 0.03}.get(method, 0.01)
    assert area(picture, method=method) == pytest.approx(AREA, rel=expected)


def test_otsu_and_triangle_agree_with_scikit_image():
    grey = median_filtered(grey_levels(photo(noise=6, blur=1)))
    counts, centres = grey_histogram(grey)
    assert otsu(counts, centres) == pytest.approx(threshold_otsu(hist=(counts, centres)), abs=1.0)
    assert triangle(counts, centres) == pytest.approx(threshold_triangle(grey, nbins=len(counts)), abs=2.0)


def test_sixteen_bits_and_floats():
    eight = photo()[..., 1]
    expected = field(eight).threshold
    assert field(eight.astype(np.uint16) * 257).threshold == pytest.approx(257 * expected)
    assert field(eight / 255.0).threshold == pytest.approx(expected / 255)


def test_the_field_is_a_crop_with_the_body_above_the_level():
    small = body(20, 15, (120.0, 40.0))
    found = field(photo(covered=small))
    assert found.values.shape[0] < 70
    assert found.values.shape[1] < 80
    assert 40 <= found.offset[1] + found.values.shape[1] / 2 - 60 <= 80
    inside = found.values > found.level
    assert inside.sum() == pytest.approx(np.pi * 20 * 15, rel=0.02)


def test_a_threshold_for_all_and_for_one_slice():
    hints = Hints(slices={2: {"threshold": 150}})
    assert field(photo(), threshold=200.0).threshold == 200
    assert field(photo(), 1, hints).threshold == 150
    assert field(photo(), 0, hints).threshold != 150
    with pytest.raises(UsageError, match="needs a threshold"):
        HistogramSegmenter(method="manual").segment(stack_of(photo()))


def test_one_threshold_for_the_stack_is_the_slices_median():
    pictures = [photo(flesh=(shade,) * 3) for shade in (80, 100, 160)]
    segmentation = HistogramSegmenter(scope="stack").segment(stack_of(*pictures))
    thresholds = {segmentation.field_of(k, picture).threshold for k, picture in enumerate(pictures)}
    assert len(thresholds) == 1
    assert thresholds.pop() == pytest.approx(field(pictures[1]).threshold)


def test_a_drawn_mask_is_the_body(tmp_path):
    drawn = np.zeros(SHAPE, dtype=np.uint8)
    drawn[40:60, 50:90] = 255
    Image.fromarray(drawn).save(tmp_path / "m.png")
    stack = stack_of(photo(), photo(), hints=Hints(slices={2: {"mask": tmp_path / "m.png"}}))
    contours = trace_stack(HistogramSegmenter().segment(stack))
    assert contours.sections[1].loops[0].signed_area == pytest.approx(800, rel=0.01)
    for content, words in ((b"", "no picture"), (b"junk", "no picture")):
        (tmp_path / "m.png").write_bytes(content)
        with pytest.raises(InputError, match=words):
            trace_stack(HistogramSegmenter().segment(stack))
    Image.fromarray(drawn[:9]).save(tmp_path / "m.png")
    with pytest.raises(InputError, match="another size"):
        trace_stack(HistogramSegmenter().segment(stack))


def test_the_background_can_be_told():
    covered = body(85, 72)
    picture = photo(covered=covered)
    told = field(picture, hints=Hints(background="light"))
    assert (told.values > told.level).sum() == pytest.approx(np.pi * 85 * 72, rel=0.01)
    assert field(photo()).notices == ()


def test_a_frame_that_is_half_body_is_said_to_be_a_guess():
    covered = np.zeros(SHAPE)
    covered[:, :88] = 1.0
    assert "background-unsure" in {notice.code for notice in field(photo(covered=covered)).notices}


def blank(noise=0.0, slope=0.0, seed=0):
    levels = 200 + slope * np.linspace(-1, 1, SHAPE[1])[None, :] + np.zeros(SHAPE)
    levels = levels + np.random.default_rng(seed).normal(0, noise, SHAPE)
    return np.rint(levels).astype(np.uint8)


@pytest.mark.parametrize(
    "picture", [blank(), blank(noise=2), blank(noise=8, seed=4), blank(noise=2, slope=30)]
)
@pytest.mark.parametrize("method", ["half-way", "otsu"])
def test_pictures_without_a_body_are_refused_by_name(picture, method):
    with pytest.raises(InputError, match=r"cut_1\.png: no body found"):
        field(picture, method=method)


def test_low_contrast_is_said():
    notices = field(photo((120,) * 3, (135,) * 3)).notices
    assert [notice.code for notice in notices] == ["low-contrast"]
    assert "cut_1.png" in notices[0].message


def test_the_3x3_median_takes_specks_away():
    picture = photo()
    specked = picture.copy()
    rng = np.random.default_rng(3)
    specked[rng.integers(0, SHAPE[0], 150), rng.integers(0, SHAPE[1], 150)] = 0
    assert area(specked) == pytest.approx(area(picture), rel=2e-3)
