"""A folder of photographs is read in order, in millimetres, and refused clearly."""

import threading
import warnings
import zlib

import numpy as np
import pytest
from PIL import Image

from stackloft.model.ends import EndKind
from stackloft.model.errors import InputError, StackloftError, UsageError
from stackloft.model.slice_stack import SectionKind
from stackloft_plugins.readers.photos import PhotosReader

READER = PhotosReader(pixel_size="0.3mm", thickness=5.0)


def picture(shade=90, shape=(30, 40), mode="L"):
    grey = np.full(shape, 240, dtype=np.uint8)
    grey[10:20, 12:30] = shade
    return Image.fromarray(grey).convert(mode)


@pytest.fixture
def folder(tmp_path):
    for number in (1, 2, 10):
        picture(50 + number).save(tmp_path / f"slice_{number}.png")
    return tmp_path


def refusal(reader, path):
    with pytest.raises(StackloftError) as caught:
        reader.read(path)
    return str(caught.value)


def test_natural_order_and_faces_at_multiples_of_the_thickness(folder):
    stack = READER.read(folder)
    assert stack.names == ("slice_1.png", "slice_2.png", "slice_10.png")
    assert stack.positions.tolist() == [0.0, 5.0, 10.0]
    assert [int(stack.decode(k).min()) for k in range(3)] == [51, 52, 60]
    assert stack.kind is SectionKind.FACE
    assert stack.pixel_spacing.tolist() == [[0.3, 0.3]] * 3
    assert stack.provenance == {"pixel size": "--pixel-size", "positions": "--thickness"}


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif", "bmp", "webp"])
def test_formats(tmp_path, suffix):
    for number in range(2):
        picture(mode="RGB").save(tmp_path / f"{number}.{suffix}")
    assert READER.read(tmp_path).decode(0).shape == (30, 40, 3)


def test_content_decides_not_the_suffix(tmp_path):
    picture().save(tmp_path / "1.dat", format="PNG")
    picture().save(tmp_path / "2.png", format="JPEG")
    (tmp_path / "notes.txt").write_text("cut on Monday")
    assert READER.read(tmp_path).names == ("1.dat", "2.png")


def test_positions_as_text_and_tuple(folder):
    as_text = PhotosReader(pixel_size=0.3, positions="0,5.6,11.1mm").read(folder)
    as_tuple = PhotosReader(pixel_size=0.3, positions=(0.0, 5.6, 11.1)).read(folder)
    assert as_text.positions.tolist() == as_tuple.positions.tolist() == [0.0, 5.6, 11.1]


def test_a_range_and_a_pattern_keep_distances(folder):
    assert PhotosReader(pixel_size=1, thickness=5, first="slice_2.png").read(folder).names == (
        "slice_2.png",
        "slice_10.png",
    )
    every_other = READER.read(folder / "slice_1*.png")
    assert every_other.names == ("slice_1.png", "slice_10.png")
    assert every_other.positions.tolist() == [0.0, 10.0]


def test_stack_toml_tells_and_flags_win(folder):
    (folder / "stack.toml").write_text(
        'pixel_size = "0.03cm"\nthickness = "4mm"\nends = "face,round:2mm"\nheight = "2cm"\n'
        'background = "light"\nspecimen = "apple 4"\nmeasured_volume = "3 mL"\n[slice.3]\nthreshold = 140\n'
    )
    stack = PhotosReader().read(folder)
    assert stack.positions.tolist() == [0.0, 4.0, 8.0]
    assert stack.pixel_spacing[0, 0] == pytest.approx(0.3)
    assert [end.kind for end in stack.hints.ends] == [EndKind.FACE, EndKind.ROUND]
    assert (stack.hints.height, stack.hints.measured_volume) == (20.0, 3000.0)
    assert stack.hints.slices == {3: {"threshold": 140}}
    flagged = PhotosReader(pixel_size=1.0, positions="1,2,4").read(folder)
    assert flagged.positions.tolist() == [1.0, 2.0, 4.0]
    assert flagged.provenance == {"pixel size": "--pixel-size", "positions": "--positions"}


def test_a_skipped_slice_leaves_its_gap_and_the_others_their_numbers(folder):
    (folder / "slice_2.png").write_bytes(b"\x89PNG\r\n\x1a\n broken")
    (folder / "stack.toml").write_text("[slice.2]\nskip = true\n[slice.3]\nthreshold = 99\n")
    stack = READER.read(folder)
    assert stack.names == ("slice_1.png", "slice_10.png")
    assert stack.positions.tolist() == [0.0, 10.0]
    assert stack.hints.slices == {2: {"threshold": 99}}
    assert stack.notices[0].code == "slice-skipped"
    assert "slice_2.png" in stack.notices[0].message


def test_a_mask_is_no_slice(folder):
    picture(255).save(folder / "mask_1.png")
    (folder / "stack.toml").write_text('[slice.1]\nmask = "mask_1.png"\n')
    stack = READER.read(folder)
    assert len(stack) == 3
    assert stack.hints.slices[1]["mask"] == folder / "mask_1.png"


def test_sixteen_bits_stay_sixteen_bits(tmp_path):
    deep = np.full((20, 20), 40_000, dtype=np.uint16)
    deep[5:15, 5:15] = 1_003
    for suffix in ("png", "tif"):
        Image.fromarray(deep).save(tmp_path / f"a.{suffix}")
    for number in range(2):
        decoded = READER.read(tmp_path).decode(number)
        assert decoded.dtype == np.uint16
        assert (decoded == deep).all()


def test_transparency_is_laid_on_paper(tmp_path):
    rgba = np.zeros((20, 20, 4), dtype=np.uint8)
    rgba[5:15, 5:15] = (90, 60, 50, 255)
    for number in range(2):
        Image.fromarray(rgba).save(tmp_path / f"{number}.png")
    light = READER.read(tmp_path).decode(0)
    assert light[0, 0].tolist() == [255, 255, 255]
    assert light[10, 10].tolist() == [90, 60, 50]
    (tmp_path / "stack.toml").write_text('background = "dark"')
    assert READER.read(tmp_path).decode(0)[0, 0].tolist() == [0, 0, 0]


@pytest.mark.parametrize("mode", ["1", "P", "CMYK", "LA", "RGBA", "I", "F"])
def test_modes(tmp_path, mode):
    for number in range(2):
        picture(mode=mode).save(tmp_path / f"{number}.tif")
    decoded = READER.read(tmp_path).decode(1)
    assert decoded.shape in {(30, 40), (30, 40, 3)}
    assert decoded.min() < decoded.max()


@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_orientation_is_undone(tmp_path, orientation):
    grey = np.zeros((20, 30), dtype=np.uint8)
    grey[:5, :10] = 200
    undo = {
        1: lambda a: a, 2: lambda a: a[:, ::-1], 3: lambda a: a[::-1, ::-1], 4: lambda a: a[::-1],
        5: lambda a: a.T, 6: np.rot90, 7: lambda a: a.T[::-1, ::-1], 8: lambda a: np.rot90(a, -1),
    }[orientation]  # fmt: skip
    exif = Image.Exif()
    exif[0x0112] = orientation
    for number in range(2):
        Image.fromarray(np.ascontiguousarray(undo(grey))).save(tmp_path / f"{number}.png", exif=exif)
    stack = READER.read(tmp_path)
    assert stack.shape == (20, 30)
    assert (stack.decode(0) == grey).all()


def test_two_threads_decode_the_same_as_one(folder):
    stack = READER.read(folder)
    expected = [stack.decode(k) for k in range(3)]
    wrong = []

    def work():
        for _ in range(20):
            wrong.extend(k for k in range(3) if not (stack.decode(k) == expected[k]).all())

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_unknown_spacing_is_an_error_never_one(folder):
    assert "pixel size is unknown" in refusal(PhotosReader(thickness=5), folder)
    message = refusal(PhotosReader(pixel_size=1), folder)
    assert "distance between the slices is unknown" in message
    assert "--thickness" in message


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"pixel_size": 0}, "must be positive"),
        ({"pixel_size": "-0.1mm"}, "must be positive"),
        ({"pixel_size": "3 ells"}, "unknown unit"),
        ({"thickness": 0}, "must be positive"),
        ({"thickness": None, "positions": "0,5"}, "differ in number"),
        ({"thickness": None, "positions": "0,5,5"}, "must increase"),
        ({"positions": "0,5,9"}, "not both"),
        ({"first": "slice_3.png"}, "no such slice"),
        ({"first": "slice_10.png", "last": "slice_1.png"}, "last comes before first"),
    ],
)
def test_wrong_options(folder, options, words):
    with pytest.raises((InputError, UsageError), match=words):
        PhotosReader(**{"pixel_size": 0.3, "thickness": 5.0, **options}).read(folder)


def test_empty_missing_and_single(tmp_path):
    assert "no pictures here" in refusal(READER, tmp_path)
    assert "does not exist" in refusal(READER, tmp_path / "nowhere")
    picture().save(tmp_path / "a.png")
    assert "one slice makes no body" in refusal(READER, tmp_path)
    assert "is no folder" in refusal(READER, tmp_path / "a.png")


def test_slices_of_different_size_are_named(folder):
    picture(shape=(31, 40)).save(folder / "slice_3.png")
    message = refusal(READER, folder)
    assert "slice_3.png (40 × 31)" in message
    assert "40 × 30" in message


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif", "bmp", "webp"])
def test_truncated_pictures_are_refused_at_the_latest_when_decoded(tmp_path, suffix):
    noise = np.random.default_rng(1).integers(0, 255, (64, 64, 3), dtype=np.uint8)
    for number in range(2):
        Image.fromarray(noise).save(tmp_path / f"{number}.{suffix}")
    whole = (tmp_path / f"1.{suffix}").read_bytes()
    for length in (len(whole) // 2, 40, 12, 0):
        (tmp_path / f"1.{suffix}").write_bytes(whole[:length])
        with pytest.raises(InputError, match=rf"1\.{suffix}") as caught:
            READER.read(tmp_path).decode(1)
        assert "\n" not in str(caught.value)


def test_animated_and_multi_page_pictures_are_refused(tmp_path):
    frames = [picture(shade) for shade in (20, 80)]
    frames[0].save(tmp_path / "a.tif", save_all=True, append_images=frames[1:])
    assert "several pages" in refusal(READER, tmp_path)
    (tmp_path / "a.tif").unlink()
    frames[0].save(tmp_path / "a.webp", save_all=True, append_images=frames[1:], lossless=True)
    assert "several pages" in refusal(READER, tmp_path)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.heic", b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", "heif-convert"),
        ("a.jpg", b"\0\0\0\x18ftypmif1\0\0\0\0mif1heic", "heif-convert"),
        ("a.avif", b"\0\0\0\x18ftypavif\0\0\0\0mif1avif", "AVIF"),
        ("a.gif", b"GIF89a" + bytes(30), "GIF"),
        ("a.png", b"", "an empty file"),
        ("a.jpg", b"not a picture at all, honestly", "though its name says so"),
    ],
)
def test_other_formats_are_refused_by_name(folder, name, content, words):
    (folder / name).write_bytes(content)
    message = refusal(READER, folder)
    assert name in message
    assert words in message


def test_a_decompression_bomb_is_refused_by_its_header(folder):
    rows = columns = 60_000
    head = bytearray((folder / "slice_1.png").read_bytes())
    head[16:24] = columns.to_bytes(4) + rows.to_bytes(4)
    head[29:33] = zlib.crc32(bytes(head[12:29])).to_bytes(4)
    (folder / "slice_1.png").write_bytes(bytes(head))
    assert "decompression bomb" in refusal(READER, folder)
    assert Image.MAX_IMAGE_PIXELS is not None


def test_pillows_warnings_stay_inside(folder):
    exif = b"Exif\0\0II*\0\x08\0\0\0\xff\xff" + b"\x12\x01\x03\0\x01\0\0\0" * 2
    for name in ("slice_1", "slice_2"):
        picture().save(folder / f"{name}.jpg", exif=exif)
        (folder / f"{name}.png").unlink()
    (folder / "slice_10.png").unlink()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        stack = READER.read(folder)
        assert stack.decode(0).shape == (30, 40)


def test_probe_by_content_raises_nothing(folder, tmp_path_factory):
    empty = tmp_path_factory.mktemp("empty")
    (empty / "a.png").write_text("no picture")
    assert READER.probe(folder) == 0.8
    assert READER.probe(folder / "slice_*.png") == 0.8
    assert [READER.probe(path) for path in (empty, empty / "a.png", empty / "gone")] == [0.0, 0.0, 0.0]


def test_stack_toml_that_points_past_the_slices(folder):
    (folder / "stack.toml").write_text("[slice.4]\nskip = true")
    assert "there is no slice 4" in refusal(READER, folder)


def test_photographs_are_no_slabs(folder):
    (folder / "stack.toml").write_text('kind = "slab"')
    assert "do not show slabs" in refusal(READER, folder)
