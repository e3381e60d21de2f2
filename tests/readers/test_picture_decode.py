"""JPEG's luminance alone, and smaller copies: quicker, and the same pictures."""

import io

import numpy as np
import pytest
from PIL import Image

from stackloft.model.reference import ReferenceKind
from stackloft_plugins.readers.picture_decode import decode_picture, decode_smaller, read_header
from stackloft_plugins.readers.reference_find import find_reference
from stackloft_plugins.readers.slice_decoder import SliceDecoder


def scene(shape=(601, 803), *, radius=150.25):
    """Return a smooth colour picture with a disc in its corner and a body."""
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    disc = np.clip(radius - np.hypot(rows - 180.3, columns - 190.7) + 0.5, 0, 1)[..., None]
    body = np.clip(180.0 - np.hypot(rows - 380.0, columns - 580.0) + 0.5, 0, 1)[..., None]
    colours = np.array([230.0, 225.0, 215.0]) * (1 - disc - body)
    return (colours + np.array([120.0, 124, 130]) * disc + np.array([150.0, 60, 50]) * body).astype(np.uint8)


def write(path, picture, orientation=1, **how):
    image = Image.fromarray(picture)
    exif = image.getexif()
    exif[0x0112] = orientation
    image.save(path, exif=exif, **how)
    return read_header(path)


@pytest.mark.parametrize("orientation", [1, 3, 6, 8])
@pytest.mark.parametrize("subsampling", [0, 2])
def test_luminance_is_that_of_the_colours(tmp_path, orientation, subsampling):
    header = write(tmp_path / "a.jpg", scene(), orientation, quality=95, subsampling=subsampling)
    colours, grey = decode_picture(header), decode_picture(header, luminance=True)
    assert grey.shape == colours.shape[:2] == header.size
    off = colours @ np.array([0.299, 0.587, 0.114]) - grey
    assert np.abs(off).max() < 1.5  # three roundings
    assert abs(off.mean()) < 0.3


@pytest.mark.parametrize("suffix", ["png", "tif", "webp"])
def test_other_formats_keep_their_colours(tmp_path, suffix):
    header = write(tmp_path / f"a.{suffix}", scene())
    assert np.array_equal(decode_picture(header, luminance=True), decode_picture(header))


def test_pictures_are_the_callers_own_to_change(tmp_path):
    for name, picture in (("a.jpg", scene()), ("b.jpg", scene()[..., 0]), ("c.png", scene())):
        decoded = decode_picture(write(tmp_path / name, picture))
        decoded[0, 0] = 7
        assert decoded.flags.c_contiguous


@pytest.mark.parametrize(("longest", "factor"), [(900, 1), (402, 1), (401, 2), (200, 4), (90, 8)])
def test_a_smaller_copy_covers_the_same_scene(tmp_path, longest, factor):
    header = write(tmp_path / "a.jpg", scene(), 6, quality=95, subsampling=0)
    copy, by = decode_smaller(header, 255, longest)
    whole = decode_picture(header).astype(float)
    assert by == factor
    assert copy.shape[:2] == tuple(-(-side // factor) for side in header.size)
    rows, columns = (side // factor for side in header.size)
    blocks = whole[: rows * factor, : columns * factor].reshape(rows, factor, columns, factor, 3)
    off = np.abs(copy[:rows, :columns] - blocks.mean(axis=(1, 3)))
    assert np.median(off) < 1.5


def test_other_formats_have_no_smaller_copy(tmp_path):
    picture = scene()
    copy, factor = decode_smaller(write(tmp_path / "a.png", picture), 255, 100)
    assert factor == 1
    assert np.array_equal(copy, picture)


@pytest.mark.parametrize("longest", [401, 200])
def test_a_reference_measured_on_a_copy_is_the_same(tmp_path, longest):
    header = write(tmp_path / "a.jpg", scene(), quality=95, subsampling=0)
    whole = find_reference(decode_picture(header), ReferenceKind.DISC)
    copy, factor = decode_smaller(header, 255, longest)
    found = find_reference(copy, ReferenceKind.DISC).enlarged(factor)
    assert found.size.size == pytest.approx(300.5, rel=1e-3)
    assert found.size.grain == factor
    assert found.size.size == pytest.approx(whole.size.size, rel=1e-3)
    assert found.centre == pytest.approx((190.7, 180.3), abs=factor)
    rows, columns = np.nonzero(found.hidden)
    distance = np.hypot(rows + found.corner[0] - 180.3, columns + found.corner[1] - 190.7)
    assert distance.max() < 1.3 * 150.25 + 6 * factor
    assert len(rows) > np.pi * 150.25**2


def test_slices_come_with_plate_over_the_reference_in_grey_as_in_colour(tmp_path):
    header = write(tmp_path / "a.jpg", scene(), quality=95, subsampling=0)
    found = find_reference(decode_picture(header), ReferenceKind.DISC)
    decode = SliceDecoder((header,), ((found,),), 255, ("left-right",))
    colours, grey = decode(0), decode.luminance(0)
    assert np.abs(colours @ np.array([0.299, 0.587, 0.114]) - grey).max() < 1.5
    assert np.ptp(grey[100:250, -280:-110]) < 4  # where the disc was, seen from the other side


def test_a_truncated_picture_is_refused_either_way(tmp_path):
    whole = io.BytesIO()
    Image.fromarray(scene()).save(whole, "JPEG")
    path = tmp_path / "a.jpg"
    path.write_bytes(whole.getvalue())
    header = read_header(path)
    path.write_bytes(whole.getvalue()[: len(whole.getvalue()) // 2])
    for decode in (
        lambda: decode_picture(header),
        lambda: decode_picture(header, luminance=True),
        lambda: decode_smaller(header, 255, 100),
    ):
        with pytest.raises(Exception, match="truncated"):
            decode()
