"""A pinhole camera's pictures: each cut face at its own scale, a reference object at its own plane's."""

import numpy as np
import pytest

from stackloft.model.errors import UsageError
from stackloft.testing import phantoms
from stackloft.testing.phantoms.camera import Camera
from stackloft.testing.phantoms.coverage import coverage
from stackloft.testing.phantoms.photographs import LEVELS, Photographs
from stackloft.testing.phantoms.reference_object import GREY, ReferenceObject


def pictures(**options):
    roast = phantoms.make("meat", length=176)
    camera = Photographs(sections=4, placing="faces", pixel_size=0.5, **options)
    z = roast.positions(4, "faces")
    cuts = [roast.section(float(height), 800) for height in z]
    frames = camera.frames(cuts, z)
    return roast, z, frames, [
        camera.picture(roast, float(z[k]), cuts[k], frames[k], k + 1).astype(float) for k in range(4)
    ]  # fmt: skip


@pytest.mark.parametrize("plane", ["fixed", "receding"])
def test_a_face_is_seen_with_pixels_in_proportion_to_its_distance(plane):
    roast, z, frames, seen = pictures(camera=Camera(600.0, plane, (310.0, 12.0)))
    plate, body = LEVELS["white"]
    for k in range(4):
        depth = 600 + (z[k] - z[0] if plane == "receding" else 0)
        covered = ((seen[k] - plate) / (body - plate)).sum() * (0.5 * depth / 600) ** 2
        exact = sum(loop.signed_area for loop in roast.section(float(z[k]), 800))
        assert covered == pytest.approx(exact, rel=2e-4)
        axis = frames[k].origin + np.array([310.0, 12.0]) * frames[k].pixel_size
        assert axis == pytest.approx(frames[0].origin + np.array([310.0, 12.0]) * 0.5)


@pytest.mark.parametrize(("stays", "depths"), [(False, [1, 1 + 44 / 600]), (True, [1, 1])])
def test_the_reference_is_seen_at_its_own_distance(stays, depths):
    thing = ReferenceObject("disc", 24.25, height=-16.0, stays=stays)
    camera = Photographs(pixel_size=0.5, camera=Camera(600.0), reference=thing)
    _, _, frames, _ = pictures(camera=Camera(600.0), reference=thing)
    for k, depth in zip((0, 1), depths, strict=True):
        size = camera._reference_scale(frames[k])
        expected = 0.5 * (depth + 16 / 600)
        assert size == pytest.approx(expected, rel=1e-12)
        drawn = coverage([thing.polygon(frames[k].shape, size)], frames[k].shape).sum()
        assert drawn * size**2 == pytest.approx(np.pi / 4 * 24.25**2, rel=2e-5)


@pytest.mark.parametrize("kind", ["disc", "square", "ruler"])
@pytest.mark.parametrize("corner", range(4))
def test_it_lies_whole_in_its_corner_clear_of_the_body(kind, corner):
    thing = ReferenceObject(kind, 20.0, corner, angle=25.0)
    *_, seen = pictures(reference=thing)
    rows, columns = np.nonzero(np.abs(seen[0] - GREY) < 1)
    assert len(rows) * 0.25 == pytest.approx({"disc": 314, "square": 400, "ruler": 88}[kind], rel=0.2)
    assert (columns.mean() > seen[0].shape[1] / 2) == (corner in {1, 2})
    assert (rows.mean() > seen[0].shape[0] / 2) == (corner in {2, 3})
    assert min(rows.min(), columns.min()) > 3


def test_once_means_the_first_picture_alone():
    *_, seen = pictures(reference=ReferenceObject("square", 20.0, pictures="first"))
    assert [bool((np.abs(picture - GREY) < 1).sum() > 400) for picture in seen] == [True, False, False, False]


@pytest.mark.parametrize("text", ["coin:3mm", "disc", "disc:0mm"])
def test_an_unknown_object_is_refused(text):
    with pytest.raises(UsageError):
        ReferenceObject.parse(text)


@pytest.mark.parametrize("text", ["600mm:sinking", "0mm"])
def test_an_impossible_camera_is_refused(text):
    with pytest.raises(UsageError):
        Camera.parse(text)
