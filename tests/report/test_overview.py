"""The overview shows every slice, with each contour where it was traced."""

import io

import numpy as np
import pytest
from PIL import Image

from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.report.overview import RUNS, write_overview
from stackloft.report.thumbnails import LARGEST, SMALLEST, TOTAL, ThumbnailSink, as_rgb, side_for

MARGIN = 12
"""Pixels from the sheet's edge to the first photograph."""


def disc_stack(count=3, shape=(300, 400), spacing=(0.5, 0.5), dtype=np.uint8, colour=False):
    """Return a stack of ellipses with centre (45, 80) mm and half axes (20, 30) mm, and its loops."""
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    inside = ((columns * spacing[1] - 45) / 20) ** 2 + ((rows * spacing[0] - 80) / 30) ** 2 < 1
    picture = np.where(inside, 200, 20).astype(dtype)
    if colour:
        picture = np.stack([picture, picture // 2, picture // 4], axis=2)
    stack = SliceStack(
        decode=lambda index: picture,
        names=tuple(f"cut_{index:02d}.png" for index in range(count)),
        shape=shape,
        positions=np.arange(count) * 5.0,
        pixel_spacing=np.tile(spacing, (count, 1)),
        kind=SectionKind.FACE,
    )
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    loop = Loop(np.column_stack([45 + 20 * np.cos(angle), 80 + 30 * np.sin(angle)]))
    sections = tuple(Section(5.0 * index, (loop,), stack.names[index]) for index in range(count))
    return stack, ContourStack(sections)


def thumbnails(stack, field=None):
    """Return what the sink keeps; without a `field` the body's window is the whole picture."""
    sink = ThumbnailSink()
    field = field or SectionField(np.zeros(stack.shape), 0.5)
    sink.begin(Segmentation(stack, lambda index, picture: field))
    for index in range(len(stack)):
        sink.add(index, stack.decode(index), field)
    return sink.end()


def overview(contours, small):
    stream = io.BytesIO()
    write_overview(contours, small, stream)
    return np.asarray(Image.open(stream).convert("RGB"))


def drawn(contours, small):
    """Return where the sheet differs from one whose sections have no loops."""
    bare = ContourStack(tuple(Section(section.z, (), section.name) for section in contours.sections))
    return (overview(contours, small) != overview(bare, small)).any(axis=2)


def off_the_ellipse(sheet, small):
    """Return the drawn pixels' distance from the ellipse, as a fraction of its size."""
    rows, columns = np.nonzero(sheet)
    x = (columns - MARGIN - small.origin[0]) / small.per_mm[0]
    y = (rows - MARGIN - small.origin[1]) / small.per_mm[1]
    assert len(rows) > 400
    return np.hypot((x - 45) / 20, (y - 80) / 30) - 1


@pytest.mark.parametrize("shape", [(300, 400), (1200, 1600)], ids=["enlarged", "reduced"])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float64])
def test_the_contour_lies_on_the_boundary_of_its_photograph(shape, dtype):
    spacing = (0.5 * 300 / shape[0], 0.5 * 300 / shape[0])
    stack, contours = disc_stack(1, shape, spacing, dtype)
    (small,) = thumbnails(stack)
    distance = off_the_ellipse(drawn(contours, [small]), small)
    assert np.abs(distance).max() < 0.04, "two pixels of a thumbnail"
    assert abs(distance.mean()) < 0.002, "a twentieth of a pixel on the whole: no half-pixel shift"
    bright = small.picture[..., 0] > 110
    rows, columns = np.nonzero(bright)
    x, y = (columns - small.origin[0]) / small.per_mm[0], (rows - small.origin[1]) / small.per_mm[1]
    assert [x.mean(), y.mean()] == pytest.approx([45, 80], abs=0.03), "the photograph is there as well"


def test_a_body_that_is_small_in_its_photograph_fills_its_thumbnail():
    stack, contours = disc_stack(1, (1200, 1600), (0.5, 0.5))
    window = SectionField(np.zeros((130, 90)), 0.5, offset=(95, 45))
    (small,) = thumbnails(stack, window)
    distance = off_the_ellipse(drawn(contours, [small]), small)
    assert abs(distance.mean()) < 0.002
    assert max(small.picture.shape) == LARGEST
    assert small.extent == pytest.approx((0.5 * (90 + 2 * 18), 0.5 * (130 + 2 * 26)))


def test_pixels_that_are_not_square_are_drawn_true_to_scale():
    stack, contours = disc_stack(1, (300, 400), (0.5, 0.25))
    rows, columns = np.nonzero(drawn(contours, thumbnails(stack)))
    assert np.ptp(rows) / np.ptp(columns) == pytest.approx(1.5, rel=0.02)


def test_every_section_is_drawn_and_a_slice_without_one_is_shown_bare():
    stack, contours = disc_stack(7)
    small = thumbnails(stack)
    without = ContourStack(contours.sections[:3] + contours.sections[4:])
    sheet = overview(contours, small)
    assert overview(without, small).shape == sheet.shape, "the bare slice keeps its place"
    assert drawn(without, small).sum() == drawn(contours, small).sum() * 6 / 7


@pytest.mark.parametrize("paint", [(255, 0, 220), (0, 225, 255), (255, 230, 0), (30, 60, 250)])
def test_the_contours_colour_stands_out_from_the_body(paint):
    stack, contours = disc_stack(1)
    (small,) = thumbnails(stack)
    small.picture[:] = paint
    where = drawn(contours, [small])
    distance = np.linalg.norm(overview(contours, [small])[where].astype(float) - paint, axis=1)
    assert np.quantile(distance, 0.75) > 150


def test_contours_without_photographs_are_drawn_alone_at_one_scale():
    _, contours = disc_stack(2)
    half = Loop(contours.sections[0].loops[0].points * 0.5)
    both = ContourStack((contours.sections[0], Section(5.0, (half,), "half")))
    sheet = overview(both, ()).astype(int)
    columns = np.nonzero((sheet[..., 2] - sheet[..., 0] > 100).any(axis=0))[0]
    gap = int(np.diff(columns).argmax())
    assert np.ptp(columns[gap + 1 :]) == pytest.approx(np.ptp(columns[: gap + 1]) / 2, rel=0.05)


def test_many_slices_make_small_thumbnails_and_few_large_ones():
    assert side_for(1) == LARGEST
    assert side_for(100_000) == SMALLEST
    assert side_for(300) ** 2 * 300 <= TOTAL


def test_thumbnails_hold_no_view_of_the_photograph():
    stack, _ = disc_stack(1, colour=True)
    (small,) = thumbnails(stack)
    assert not np.shares_memory(small.picture, stack.decode(0))
    assert small.picture.shape == (360, 480, 3)


def test_a_flat_picture_and_one_with_gaps_become_rgb():
    assert as_rgb(np.full((2, 2), 7.0)).max() == 0
    assert as_rgb(np.array([[np.nan, 0.0], [1.0, 1.0]])).shape == (2, 2, 3)


def test_loops_that_go_on_as_each_other_have_one_colour_and_others_another():
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)

    def disc(x, radius):
        return Loop(np.column_stack([x + radius * np.cos(angle), radius * np.sin(angle)]))

    whole, parts = (disc(0.0, 20.0),), (disc(-11.0, 9.0), disc(11.0, 8.0))
    loops = [whole, whole, parts, parts]
    picture = overview(ContourStack(tuple(Section(float(z), own, str(z)) for z, own in enumerate(loops))), [])
    away = np.linalg.norm(picture[:, :, None].astype(float) - np.array(RUNS, dtype=float), axis=3)
    counts = [int((away[:, :, k] < 40.0).sum()) for k in range(len(RUNS))]
    assert min(counts[:3]) > 50
    assert max(counts[3:]) == 0
