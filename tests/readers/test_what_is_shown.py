"""Caps, silhouettes and both faces of a slice are measured as what they are."""

import numpy as np
import pytest
from PIL import Image

import stackloft
from stackloft.model.errors import StackloftError
from stackloft.testing import phantoms
from stackloft.testing.phantoms.coverage import coverage
from stackloft.testing.phantoms.photographs import Photographs

SLICES = 12


def pictures(folder, shown, rotation=None):
    """Write an ellipsoid's slices; `shown` gives each picture's z range seen; return body and thickness."""
    body = phantoms.make("ellipsoid", rotation=rotation)
    low, high = body.extent()
    pitch = (high - low) / SLICES
    inside = np.linspace(low + 0.02 * pitch, high - 0.02 * pitch, 33)
    frame = Photographs(pixel_size=0.5).frames([body.section(float(z), 400) for z in inside], inside)[0]
    for number, (first, last, mirrored) in enumerate(shown(low, high, pitch)):
        covered = np.zeros(frame.shape)
        for z in np.unique(np.clip(np.linspace(first, last, 9), low + 1e-3, high - 1e-3)):
            covered = np.maximum(covered, coverage(frame.polygons(body.section(float(z), 400)), frame.shape))
        grey = np.round(230 - 170 * covered).astype(np.uint8)
        Image.fromarray(grey[:, ::-1] if mirrored else grey).save(folder / f"cut_{number:02d}.png")
    return body, pitch


def slabs(low, high, pitch):
    return [(low + k * pitch, low + (k + 1) * pitch, False) for k in range(SLICES)]


def faces_and_cap(low, high, pitch):
    first = (low, low + pitch, False)
    return [first, *((low + k * pitch, low + k * pitch, False) for k in range(1, SLICES))]


def both_faces(low, high, pitch):
    tops = [low + (k + 0.02) * pitch for k in range(SLICES)]
    pairs = [((z, z, False), (z + 0.95 * pitch, z + 0.95 * pitch, True)) for z in tops]
    return [one for pair in pairs for one in pair]


def volume(folder, body, pitch, **options):
    result = stackloft.measure(folder, pixel_size=0.5, thickness=pitch, settings={"reader": options})
    return result.objects[0].volume.value / body.volume - 1, {notice.code for notice in result.warnings}


def test_silhouettes_are_put_where_they_are_sections(tmp_path):
    body, pitch = pictures(tmp_path, slabs)
    assert volume(tmp_path, body, pitch)[0] > 0.05
    for more in ({}, {"first_shows": "cap"}):
        off, _ = volume(tmp_path, body, pitch, section="silhouette", **more)
        assert abs(off) < 0.003
    with pytest.raises(StackloftError, match="widest plane below"):
        volume(tmp_path, body, pitch, section="silhouette", plane="receding", camera_distance=600.0)


@pytest.mark.parametrize(("tilt", "leans"), [(0.0, False), (20.0, False), (45.0, True)])
def test_leaning_silhouettes_tell_what_that_costs(tmp_path, tilt, leans):
    body, pitch = pictures(tmp_path, slabs, rotation=(tilt, 0, 0))
    settings = {"reader": {"section": "silhouette"}}
    result = stackloft.measure(tmp_path, pixel_size=0.5, thickness=pitch, settings=settings)
    off = 100 * (result.objects[0].volume.value / body.volume - 1)
    told = [notice.message for notice in result.warnings if notice.code != "end-guessed"]
    assert bool(told) is leans
    if not leans:
        assert abs(off) < 0.4
    else:
        assert "drift aside" in told[0]
        said = float(told[0].split("volume about ")[1].split(" %")[0])
        assert said == pytest.approx(off, abs=0.3)


def test_a_cap_is_left_out_and_tells_where_the_body_ends(tmp_path):
    body, pitch = pictures(tmp_path, faces_and_cap)
    before, _ = volume(tmp_path, body, pitch)
    off, codes = volume(tmp_path, body, pitch, first_shows="cap")
    assert abs(off) < 0.004 < abs(before)
    assert "cap-left-out" in codes


def test_both_faces_are_sections_of_their_own(tmp_path):
    body, pitch = pictures(tmp_path, both_faces)
    off, codes = volume(tmp_path, body, 0.95 * pitch, faces="both", kerf=0.05 * pitch)
    assert abs(off) < 0.004
    assert "misaligned" not in codes


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('section = "slab"', "section is wrong"),
        ('first = "skin"', "first is wrong"),
        ('faces = "two"', "faces is wrong"),
        ('turned = "up-down"', "one face of each"),
        ('kind = "face"\nsection = "silhouette"', "contradict each other"),
        ('faces = "both"\nsection = "silhouette"', "not seen as silhouettes"),
    ],
)
def test_wrong_words_are_refused(tmp_path, line, words):
    for number in range(2):
        Image.new("L", (40, 30), 255).save(tmp_path / f"{number}.png")
    (tmp_path / "stack.toml").write_text(f"pixel_size = 1\nthickness = 5\n{line}\n")
    with pytest.raises(StackloftError, match=words):
        stackloft.read(tmp_path)
