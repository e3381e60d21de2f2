"""The built-in readers pass the kit that strangers run."""

import io

import numpy as np
import pytest
from PIL import Image

from stackloft.registry import find
from stackloft.testing.conformance.reader_case import ReaderCase
from stackloft.testing.conformance.reader_checks import reader_checks


def picture(k):
    rows, columns = np.mgrid[:60, :80]
    grey = np.where((rows - 30) ** 2 + (columns - 40 - k % 7) ** 2 < (15 + k % 5) ** 2, 90, 235)
    noise = np.random.default_rng(k).normal(0, 3, grey.shape)
    return Image.fromarray((grey + noise).clip(0, 255).astype(np.uint8))


def photographs(suffix, mode="L"):
    def write(folder, slices):
        for k in range(slices):
            stream = io.BytesIO()
            picture(k).convert(mode).save(stream, {".jpg": "JPEG", ".tif": "TIFF"}.get(suffix, suffix[1:]))
            (folder / f"slice_{k + 1}{suffix}").write_bytes(stream.getvalue())
        return folder

    return write


def table(columns):
    def write(folder, slices):
        rows = [columns]
        for k in range(slices):
            for angle in np.linspace(0, 2 * np.pi, 24, endpoint=False):
                x, y = (10 + k % 3) * np.cos(angle), (8 + k % 2) * np.sin(angle)
                z = f"{2.5 * k}," if ",z," in columns else ""
                rows.append(f"{k + 1},{z}1,{float(x)!r},{float(y)!r}")
        path = folder / "body.csv"
        path.write_text("\n".join(rows) + "\n")
        return path

    return write


def photos_case(suffix, mode="L"):
    reader = find("reader", "photos").plugin
    options = {"pixel_size": "0.3mm", "thickness": "5mm"}
    return ReaderCase(reader, photographs(suffix, mode), options, tuple(options))


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif", ".bmp", ".webp"])
@pytest.mark.parametrize("check", reader_checks(photos_case(".png")), ids=str)
def test_photos(check, suffix):
    next(again for again in reader_checks(photos_case(suffix)) if again.name == check.name)()


@pytest.mark.parametrize("check", reader_checks(photos_case(".png", "RGB")), ids=str)
def test_colour_photos(check):
    check()


CONTOURS = ReaderCase(
    find("reader", "contours").plugin, table("section,z,loop,x,y"), without_spacing=table("section,loop,x,y")
)
UNDETECTABLE = {
    "refuses-truncated": "a table cut off between two rows is a table, and says nothing of what is missing",
}


@pytest.mark.parametrize("check", reader_checks(CONTOURS, UNDETECTABLE), ids=str)
def test_contours(check):
    check()
