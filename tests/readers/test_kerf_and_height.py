"""The blade's own thickness counts, and a height that the slices do not make up is told."""

import numpy as np
import pytest
from PIL import Image

from stackloft.model.errors import UsageError
from stackloft_plugins.readers.photos import PhotosReader


@pytest.fixture
def folder(tmp_path):
    grey = np.full((40, 50), 240, dtype=np.uint8)
    grey[10:30, 10:40] = 80
    for number in range(5):
        Image.fromarray(grey).save(tmp_path / f"{number}.png")
    return tmp_path


def test_the_pitch_is_thickness_and_kerf(folder):
    stack = PhotosReader(pixel_size=0.3, thickness=5, kerf="0.4mm").read(folder)
    assert stack.positions == pytest.approx(5.4 * np.arange(5))
    (folder / "stack.toml").write_text("pixel_size = 0.3\nthickness = 5\nkerf = 0.5\n")
    assert PhotosReader().read(folder).positions[1] == pytest.approx(5.5)
    assert PhotosReader(kerf=0.0).read(folder).positions[1] == pytest.approx(5.0)
    with pytest.raises(UsageError, match="negative"):
        PhotosReader(kerf=-1.0).read(folder)


@pytest.mark.parametrize(
    ("height", "silent"), [(27.0, True), (22.0, True), (32.4, True), (36, False), (20, False)]
)
def test_the_height_is_compared_with_the_sum(folder, height, silent):
    (folder / "stack.toml").write_text(f"pixel_size = 0.3\nthickness = 5\nkerf = 0.5\nheight = {height}\n")
    notices = PhotosReader().read(folder).notices
    assert ([notice.code for notice in notices] == []) is silent
    if not silent:
        assert "5 slices of 5 mm and cuts of 0.5 mm make 27 mm" in notices[0].message
    assert PhotosReader(last="3.png").read(folder).notices == ()
