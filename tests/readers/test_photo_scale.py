"""Pinhole pictures are measured right by each way to the scale, and a missing way is told with its cost."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import stackloft
from stackloft.model.errors import InputError, StackloftError
from stackloft.testing import phantoms
from stackloft.testing.phantoms.camera import Camera
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism
from stackloft.testing.phantoms.reference_object import ReferenceObject
from stackloft_plugins.readers.photos import PhotosReader

BODIES = {
    "meat": {"sections": 11, "placing": "faces", "pixel_size": 0.24, "parameters": {"length": 176.0}},
    "apple": {"sections": 15, "placing": "mid", "pixel_size": 0.21, "parameters": {"diameter": 88.0}},
}
COIN = ReferenceObject("disc", 24.25)


def written(folder, name, camera, reference, tell, realistic=True):
    body = dict(BODIES[name]) | ({} if realistic else {"pixel_size": 0.4})
    phantom = phantoms.make(name, **body.pop("parameters"))
    look = {"realism": Realism.of(name, seed=3), "suffix": "jpg"} if realistic else {}
    plate = "black" if name == "apple" else "white"
    keys = ("thickness", "ends", "height", *tell)
    camera_class = Photographs(camera=camera, reference=reference, plate=plate, tell=keys, **look, **body)
    camera_class.write(phantom, folder)
    return phantom


def errors(folder, phantom, **options):
    result = stackloft.measure(folder, **options)
    one = result.objects[0]
    codes = [notice.code for notice in result.warnings]
    return one.volume.value / phantom.volume - 1, one.area.value / phantom.area - 1, codes


def pitch(name):
    return 16.0 if name == "meat" else 5.7


CASES = [
    (name, distance, plane, way)
    for name in BODIES
    for distance in (600.0, 1000.0)
    for plane in ("fixed", "receding")
    for way in ("every", "first")
]
FEW = [CASES[3], CASES[8]]


def check_way(tmp_path, name, distance, plane, way):
    thing = replace(COIN, height=-pitch(name), pictures=way)
    tell = ("reference", "reference_height", "camera")
    phantom = written(tmp_path, name, Camera(distance, plane), thing, tell)
    volume, area, codes = errors(tmp_path, phantom)
    assert abs(volume) < 0.005
    assert abs(area) < 0.01
    assert not {code for code in codes if code.startswith(("scale", "reference"))}
    return volume, area


@pytest.mark.parametrize(("name", "distance", "plane", "way"), FEW)
def test_a_reference_and_the_camera_give_the_scale_of_each_slice(tmp_path, name, distance, plane, way):
    check_way(tmp_path, name, distance, plane, way)


@pytest.mark.prove
def test_all_pinhole_stacks(tmp_path, proof):
    rows = []
    for name, distance, plane, way in CASES:
        folder = tmp_path / f"{name}{distance:g}{plane}{way}"
        volume, area = check_way(folder, name, distance, plane, way)
        rows.append((name, f"{distance:g} mm", plane, way, f"{100 * volume:+.3f} %", f"{100 * area:+.3f} %"))
    proof(
        "photo-scale",
        "A reference one slice below the face and the camera's distance: V within 0.5 %, S within 1 %",
        ("body", "camera", "cut plane", "pictures with reference", "V error", "S error"),
        rows,
    )


@pytest.mark.parametrize("kind", ["disc", "square", "ruler"])
def test_a_reference_in_the_plane_of_every_face_needs_no_camera(tmp_path, kind):
    thing = ReferenceObject(kind, 30.0, corner=2, angle=11.0)
    phantom = written(tmp_path, "meat", Camera(600.0), thing, ("reference",), realistic=False)
    volume, area, codes = errors(tmp_path, phantom)
    assert max(abs(volume), abs(area)) < 0.004
    assert not codes


def test_it_may_stay_on_the_table_while_the_faces_recede(tmp_path):
    thing = replace(COIN, height=-176.0, stays=True)
    tell = ("reference", "reference_height", "reference_stays", "camera")
    phantom = written(tmp_path, "meat", Camera(800.0), thing, tell, realistic=False)
    volume, area, codes = errors(tmp_path, phantom)
    assert max(abs(volume), abs(area)) < 0.004
    assert not codes


def test_the_first_faces_pixel_size_serves_when_the_camera_is_told(tmp_path):
    phantom = written(tmp_path, "meat", Camera(600.0), None, ("pixel_size", "camera"), realistic=False)
    volume, area, codes = errors(tmp_path, phantom)
    assert max(abs(volume), abs(area)) < 0.004
    assert not codes


@pytest.mark.parametrize("tell", [("pixel_size",), ("reference", "reference_height")])
def test_without_the_camera_a_warning_tells_the_cost(tmp_path, tell):
    thing = replace(COIN, pictures="first") if "reference" in tell else None
    phantom = written(tmp_path, "meat", Camera(1000.0), thing, tell, realistic=False)
    result = stackloft.measure(tmp_path)
    off = result.objects[0].volume.value / phantom.volume - 1
    (notice,) = [one for one in result.warnings if one.code == "scale-plane-unknown"]
    assert off < -0.08
    assert "-13.7 % at 1000 mm" in notice.message
    assert tmp_path.name in notice.message


def test_a_reference_off_the_face_without_a_distance_is_told_to_cost(tmp_path):
    thing = replace(COIN, height=-16.0)
    written(tmp_path, "meat", Camera(600.0), thing, ("reference", "reference_height"), realistic=False)
    (notice,) = PhotosReader().read(tmp_path).notices
    assert notice.code == "scale-plane-unknown"
    assert "+5.4 % at 600 mm" in notice.message


def test_plain_pictures_with_a_pixel_size_are_believed(tmp_path):
    written(tmp_path, "meat", None, None, ("pixel_size",), realistic=False)
    stack = PhotosReader().read(tmp_path)
    assert stack.notices == ()
    assert stack.origins is None


def test_saying_that_the_plane_is_fixed_is_enough(tmp_path):
    phantom = written(tmp_path, "apple", Camera(600.0, "fixed"), None, ("pixel_size",), realistic=False)
    assert errors(tmp_path, phantom)[2] == ["scale-plane-unknown"]
    volume, _, codes = errors(tmp_path, phantom, plane="fixed")
    assert abs(volume) < 0.004
    assert codes == []


def test_the_reference_is_hidden_and_its_uncertainty_carried(tmp_path):
    written(tmp_path, "apple", Camera(600.0, "fixed"), COIN, ("reference", "camera"))
    stack = PhotosReader().read(tmp_path)
    corner = stack.decode(4)[:150, :150].astype(float)
    assert np.ptp(corner.mean(axis=2)) < 40  # a black plate, and no coin of 200
    assert 1e-5 < stack.scale_uncertainty.common < 2e-3
    assert stack.scale_uncertainty.each.shape == (15,)
    contours = stackloft.measure(tmp_path)
    assert contours.objects[0].sections[7].loops == 1
    assert not [one for one in contours.warnings if one.code == "second-object"]


def test_the_principal_point_is_where_slices_are_scaled_about(tmp_path):
    camera = Camera(600.0, "receding", (40.0, 30.0))
    written(tmp_path, "meat", camera, None, ("pixel_size", "camera"), realistic=False)
    text = (tmp_path / "stack.toml").read_text().replace(" }", ", principal_point = [40, 30] }")
    (tmp_path / "stack.toml").write_text(text)
    stack = PhotosReader().read(tmp_path)
    place = stack.origins + stack.pixel_spacing[:, ::-1] * [40.0, 30.0]
    assert place == pytest.approx(np.broadcast_to(place[0], place.shape))
    assert stack.pixel_spacing[-1, 0] == pytest.approx(0.4 * (760 / 600))


def test_sizes_told_for_each_picture(tmp_path):
    written(tmp_path, "meat", Camera(600.0), None, (), realistic=False)
    sizes = Camera(600.0).pixel_sizes(0.4, np.arange(11) * 16.0)
    stack = PhotosReader(pixel_sizes=tuple(sizes)).read(tmp_path)
    assert stack.pixel_spacing[:, 0] == pytest.approx(sizes)
    (tmp_path / "stack.toml").write_text(
        'thickness = 16\npixel_size = "0.24mm"\n[slice.3]\npixel_size = "0.3mm"\n'
    )
    assert PhotosReader(plane="fixed").read(tmp_path).pixel_spacing[:4, 0].tolist() == [0.24, 0.24, 0.3, 0.24]
    with pytest.raises(InputError, match="2 sizes for 11"):
        PhotosReader(pixel_sizes=(0.2, 0.3), thickness=16).read(tmp_path)


def test_a_flatbed_scans_resolution_tags(tmp_path):
    for number in range(2):
        grey = np.full((60, 80), 240, dtype=np.uint8)
        grey[20:40, 20:50] = 80
        Image.fromarray(grey).save(tmp_path / f"{number}.png", dpi=(300, 600))
    stack = PhotosReader(dpi=True, thickness=5).read(tmp_path)
    assert stack.pixel_spacing[0] == pytest.approx([25.4 / 600, 25.4 / 300], rel=1e-3)
    Image.fromarray(grey).save(tmp_path / "1.png")
    with pytest.raises(InputError, match=r"1\.png: has no resolution tag"):
        PhotosReader(dpi=True, thickness=5).read(tmp_path)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"reference": "coin:3mm"}, "disc:24.25mm"),
        ({"reference": "square:20mm"}, "no reference object (square:20mm) in any picture"),
        ({"reference_height": "3mm", "pixel_size": 0.3}, "which it is"),
        ({"pixel_size": 0.3, "dpi": True}, "contradict"),
        ({}, "--reference disc:24.25mm"),
    ],
)
def test_what_cannot_be_scaled_is_refused(tmp_path, options, words):
    written(tmp_path, "apple", None, COIN, (), realistic=False)
    with pytest.raises(StackloftError) as caught:
        PhotosReader(thickness=5, **options).read(tmp_path)
    assert words in str(caught.value)


def test_a_told_size_that_the_reference_contradicts(tmp_path):
    written(tmp_path, "apple", None, COIN, ("pixel_size", "reference"), realistic=False)
    assert PhotosReader().read(tmp_path).notices == ()
    (notice,) = PhotosReader(pixel_size=0.42).read(tmp_path).notices
    assert notice.code == "scale-disagrees"
    assert "+5.0 %" in notice.message


def test_a_reference_cut_by_the_border(tmp_path):
    written(tmp_path, "meat", None, replace(COIN, gap=-6.0), ("reference",), realistic=False)
    with pytest.raises(InputError, match="cut off by the picture's border"):
        PhotosReader().read(tmp_path)
