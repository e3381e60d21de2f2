"""The reference object is found in rendered scenes, measured to 0.2 %, and food is never taken for it."""

import io

import numpy as np
import pytest
from PIL import Image

from stackloft.model.reference import ReferenceKind
from stackloft.testing import phantoms
from stackloft.testing.phantoms.photographs import Photographs
from stackloft.testing.phantoms.realism import Realism
from stackloft.testing.phantoms.reference_object import ReferenceObject
from stackloft_plugins.readers.reference_find import find_reference, hide
from stackloft_plugins.readers.reference_sighting import Found, Missing

NAMES = ("apple", "meat", "potato", "banana", "ellipsoid", "cylinder", "box")
SIZES = {"disc": 24.25, "square": 20.0, "ruler": 50.0}


def scene(seed, *, forgotten=False):
    """Return a realistic JPEG's pixels, the object in it (unless forgotten), and how the camera saw it."""
    rng = np.random.default_rng(seed)
    kind = list(SIZES)[seed % 3]
    name = NAMES[rng.integers(len(NAMES))]
    body = phantoms.make(name)
    low, high = body.extent()
    z = low + (high - low) * rng.uniform(0.04, 0.96)
    plate = {"apple": "black", "meat": "white"}.get(name, ("white", "black")[seed % 2])
    angle = 0.0 if kind == "disc" else float(rng.uniform(-30, 30))
    thing = ReferenceObject(kind, SIZES[kind], int(rng.integers(4)), angle, gap=float(rng.uniform(2, 6)))
    camera = Photographs(
        pixel_size=float(rng.uniform(0.15, 0.35)),
        reference=None if forgotten else thing,
        plate=plate,
        realism=Realism.of(name, seed=seed),
        suffix="jpg",
        turn=float(rng.uniform(0, 360)),
    )
    loops = body.section(z, 800)
    cuts = [body.section((low + high) / 2, 200), loops]
    frame = camera.frames(cuts, np.array([0.0, 1.0]))[0]
    picture = camera.picture(body, z, loops, frame, 1)
    return np.asarray(Image.open(io.BytesIO(camera.encoded(picture)))), thing, frame


def check_scene(seed):
    picture, thing, frame = scene(seed)
    found = find_reference(picture, ReferenceKind(thing.kind))
    assert isinstance(found, Found), (seed, found)
    error = found.size.size * frame.pixel_size / thing.size - 1
    assert abs(error) < 0.002, (seed, error)
    own = thing.polygon(frame.shape, frame.pixel_size)
    assert np.linalg.norm(own.mean(axis=0) - 0.5 - found.centre) < 8, seed
    return error


@pytest.mark.parametrize("seed", range(12))
def test_a_reference_is_found(seed):
    check_scene(seed)


def food_taken(seed):
    """Return whether food is taken for the object where that was forgotten."""
    picture, thing, _ = scene(seed, forgotten=True)
    return isinstance(find_reference(picture, ReferenceKind(thing.kind)), Found)


@pytest.mark.parametrize("seed", range(9))
def test_food_is_not_taken_for_a_forgotten_reference(seed):
    assert not food_taken(seed)


@pytest.mark.prove
def test_a_reference_is_found_in_100_of_100_scenes(proof):
    errors = np.array([check_scene(seed) for seed in range(100)])
    taken = np.array([food_taken(seed) for seed in range(100)])
    rows = [
        (
            kind,
            len(errors[k::3]),
            f"{100 * np.abs(errors[k::3]).max():.3f} %",
            f"{100 * errors[k::3].std():.3f} %",
            int(taken[k::3].sum()),
        )
        for k, kind in enumerate(SIZES)
    ]
    claim = (
        "The reference object found in 100 of 100 scenes, its scale within 0.2 %; how often food is taken "
        "for it in the same scenes without it"
    )
    header = ("object", "scenes", "largest error", "standard deviation", "food taken when it is not there")
    proof("reference-scenes", claim, header, rows)
    assert not taken.any()


@pytest.mark.parametrize("shape", ["disc", "square"])
@pytest.mark.parametrize("place", [(100, 150), (40, 45)])
def test_food_of_its_shape_alone_in_the_picture_is_not_taken(shape, place):
    rows, columns = np.mgrid[:200, :300]
    away = np.abs(np.stack([rows - place[0], columns - place[1]]))
    inside = np.hypot(*away) < 30 if shape == "disc" else away.max(axis=0) < 30
    picture = np.where(inside, 90, 240).astype(np.uint8)
    picture[180:183, 280:283] = 100  # a crumb is no company
    assert isinstance(find_reference(picture, ReferenceKind(shape)), Missing)


def test_round_food_is_not_taken_when_the_coin_is_cut_off():
    rows, columns = np.mgrid[:200, :300]
    picture = np.full((200, 300), 240, dtype=np.uint8)
    picture[np.hypot(rows - 100, columns - 180) < 60] = 90
    picture[np.hypot(rows - 10, columns - 20) < 18] = 120
    found = find_reference(picture, ReferenceKind.DISC)
    assert isinstance(found, Missing)
    assert found.cut_off


def test_hiding_leaves_food_beside_it_alone():
    picture = np.full((200, 300), 240, dtype=np.uint8)
    picture[60:160, 66:260] = 90
    picture[20:60, 20:60] = 120
    found = find_reference(picture, ReferenceKind.SQUARE)
    hidden = picture.copy()
    hide(hidden, found)
    assert (hidden[20:60, 20:60] == 240).all()
    assert (hidden[60:160, 66:260] == 90).all()


@pytest.mark.parametrize("dtype", [np.uint16, np.float32, np.int32])
def test_deep_and_large_pictures(dtype):
    picture = np.full((1500, 2200), 60000, dtype=dtype)
    picture[500:1200, 900:2000] = 12000
    rows, columns = np.mgrid[:1500, :2200]
    distance = np.hypot(rows - 180.3, columns - 190.7) - 120.25
    picture = np.where(distance < 0.5, 60000 - 30000 * np.clip(0.5 - distance, 0, 1), picture).astype(dtype)
    found = find_reference(picture, ReferenceKind.DISC)
    assert found.size.size == pytest.approx(240.5, abs=0.1)
