"""Damaged and hostile pictures: one clear line that names the file, or a sound picture; nothing else."""

import io
import struct
import time
import zlib

import numpy as np
import pytest
from PIL import Image, ImageCms

from stackloft.model.errors import StackloftError
from stackloft_plugins.readers.photos import PhotosReader

READER = PhotosReader(pixel_size=0.3, thickness=5.0)
FORMATS = {"jpg": "JPEG", "png": "PNG", "tif": "TIFF", "webp": "WEBP", "bmp": "BMP"}
SHAPE = (60, 80)


def pixels(rng, mode="RGB"):
    grey = np.full((*SHAPE, 3), 235, dtype=np.uint8)
    grey[18:42, 20:60] = (150, 60, 60)
    noisy = grey + rng.normal(0, 3, grey.shape)
    return Image.fromarray(noisy.clip(0, 255).astype(np.uint8)).convert(mode)


def encoded(rng, suffix, mode="RGB", **options):
    stream = io.BytesIO()
    pixels(rng, mode).save(stream, FORMATS[suffix], **options)
    return stream.getvalue()


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def truncated(rng, suffix):
    whole = encoded(rng, suffix)
    return suffix, whole[: int(rng.integers(1, len(whole) - 1))], False


def zero_size(rng, suffix):
    return suffix, b"", True


def other_content(rng, suffix):
    contents = [
        b"%PDF-1.7\n", b"section,z,x,y\n", b"<html></html>", b"PK\x03\x04" + bytes(40), rng.bytes(300),
        b"\x00\x00\x00\x18ftypheic" + bytes(40), b"\x00\x00\x00\x18ftypavif" + bytes(40),
        b"GIF89a" + bytes(40),
    ]  # fmt: skip
    return suffix, contents[int(rng.integers(len(contents)))], True


def other_suffix(rng, suffix):
    return ("png" if suffix == "jpg" else "jpg"), encoded(rng, suffix), False


def bomb(rng, suffix):
    side = int(rng.integers(30_000, 60_000))
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0))
    body = zlib.compress(bytes(100_000))
    png = b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", body) + chunk(b"IEND", b"")
    bmp = (
        b"BM"
        + struct.pack("<IHHI", 54, 0, 0, 54)
        + struct.pack("<IiiHHIIiiII", 40, side, side, 1, 24, *[0] * 6)
    )
    return ("png", png, True) if rng.integers(2) else ("bmp", bmp, True)


def broken_exif(rng, suffix):
    orientation = rng.bytes(int(rng.integers(1, 60)))
    options = {"exif": b"Exif\x00\x00" + orientation} if suffix in {"jpg", "png", "webp"} else {}
    return suffix, encoded(rng, suffix, **options), False


def flipped_bytes(rng, suffix):
    whole = bytearray(encoded(rng, suffix))
    for _ in range(int(rng.integers(1, 30))):
        whole[int(rng.integers(len(whole)))] = int(rng.integers(256))
    return suffix, bytes(whole), False


def several_frames(rng, suffix):
    stream = io.BytesIO()
    form = {"tif": "TIFF", "webp": "WEBP"}.get(suffix, "PNG")
    pixels(rng).save(stream, form, save_all=True, append_images=[pixels(rng)])
    return {"TIFF": "tif", "WEBP": "webp", "PNG": "png"}[form], stream.getvalue(), True


def broken_profile(rng, suffix):
    options = {"icc_profile": rng.bytes(200)} if suffix != "bmp" else {}
    return suffix, encoded(rng, suffix, **options), False


def another_size(rng, suffix):
    stream = io.BytesIO()
    size = (SHAPE[0], SHAPE[1]) if rng.integers(2) else (1, int(rng.integers(1, 3)))
    Image.new("RGB", size).save(stream, FORMATS[suffix])
    return suffix, stream.getvalue(), True


def long_text(rng, suffix):
    text = zlib.compress(bytes(80_000_000), 9)
    png = encoded(rng, "png")
    return "png", png[:33] + chunk(b"zTXt", b"Comment\x00\x00" + text) + png[33:], False


KINDS = (
    truncated, zero_size, other_content, other_suffix, bomb, broken_exif, flipped_bytes, several_frames,
    broken_profile, another_size, long_text,
)  # fmt: skip


def check(folder, seed):
    """Return whether the stack was refused."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    suffix, content, must_refuse = kind(rng, list(FORMATS)[int(rng.integers(len(FORMATS)))])
    folder.mkdir()
    for number in (1, 3):
        (folder / f"slice_{number}.png").write_bytes(encoded(rng, "png"))
    bad = folder / f"slice_2.{suffix}"
    bad.write_bytes(content)
    start = time.perf_counter()
    try:
        stack = READER.read(folder)
        for number in range(len(stack)):
            assert stack.decode(number).shape[:2] == SHAPE
    except StackloftError as error:
        text = str(error)
        assert "\n" not in text
        assert bad.name in text, (seed, kind.__name__, text)
        assert len(text) < 500
        refused = True
    else:
        refused = False
        assert not must_refuse, (seed, kind.__name__)
    assert time.perf_counter() - start < 20
    return refused


@pytest.mark.parametrize("seed", range(44))
def test_a_hostile_picture_is_refused_in_one_line_or_is_sound(tmp_path, seed):
    check(tmp_path / "stack", seed)


@pytest.mark.prove
def test_two_hundred_hostile_pictures(tmp_path, proof):
    refused = np.zeros(len(KINDS), dtype=int)
    for seed in range(220):
        refused[seed % len(KINDS)] += check(tmp_path / str(seed), seed)
    rows = [(kind.__name__.replace("_", " "), 20, count) for kind, count in zip(KINDS, refused, strict=True)]
    claim = "Damaged and hostile pictures: each refused in one line that names it, or read as sound"
    proof("hostile-pictures", claim, ("what is wrong", "pictures", "refused"), rows)


def test_cmyk_and_profiles_are_read_and_noted(tmp_path):
    rng = np.random.default_rng(0)
    profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    (tmp_path / "1.jpg").write_bytes(encoded(rng, "jpg", "CMYK"))
    (tmp_path / "2.png").write_bytes(encoded(rng, "png", icc_profile=profile))
    stack = READER.read(tmp_path)
    assert stack.decode(0).shape == (*SHAPE, 3)
    assert abs(float(stack.decode(0)[2, 2].mean()) - 235) < 6
    assert stack.provenance["colour profile"] == "sRGB built-in (1 of 2); not applied"


def test_pages_and_heic_name_the_command(tmp_path):
    rng = np.random.default_rng(0)
    (tmp_path / "1.png").write_bytes(encoded(rng, "png"))
    stream = io.BytesIO()
    pixels(rng).save(stream, "TIFF", save_all=True, append_images=[pixels(rng)])
    (tmp_path / "2.tif").write_bytes(stream.getvalue())
    with pytest.raises(StackloftError, match=r"2\.tif.*2 frames.*magick 2\.tif slice_%03d\.png"):
        READER.read(tmp_path)
    (tmp_path / "2.tif").unlink()
    (tmp_path / "2.heic").write_bytes(b"\x00\x00\x00\x18ftypheic" + bytes(40))
    with pytest.raises(StackloftError, match=r"2\.heic.*heif-convert -q 95 2\.heic 2\.jpg"):
        READER.read(tmp_path)
