"""The whole route on photographs of bodies with exact answers: decode, segment, trace, loft, integrate."""

import json

import numpy as np
import pytest

import stackloft
from stackloft.testing.phantoms.writing import write_phantom

FACES = {"placing": "faces"}
TOLD = "height"

BODIES = {
    "ellipsoid": ({}, {}),
    "ellipsoid, pose 2": ({"rotation": 2}, {}),
    "potato, seed 1": ({"parameters": {"seed": 1}}, {}),
    "potato, seed 2, pose 4": ({"parameters": {"seed": 2}, "rotation": 4}, {}),
    "apple": ({}, {}),
    "superellipsoid p 2": ({"parameters": {"p": 2}}, {}),
    "superellipsoid p 2.5": ({}, {TOLD: True}),
    "superellipsoid p 3 n 4": ({"parameters": {"p": 3, "n": 4}}, {TOLD: True}),
    "cone": ({}, {"ends": "flat,point", TOLD: True}),
    "double-cone": ({}, {"ends": "point"}),
    "banana": ({}, {TOLD: True}),
    "two-lobed, 15 sections": ({"sections": 15}, {}),
    "two-lobed, 40 sections": ({"sections": 40}, {}),
    "dumbbell, 25 sections": ({"sections": 25}, {}),
    "box": (FACES, {"ends": "face"}),
    "prism": (FACES, {"ends": "face"}),
    "cylinder": (FACES, {"ends": "face"}),
    "frustum": (FACES, {"ends": "face"}),
    "twisted-bar": (FACES, {"ends": "face"}),
    "meat": (FACES, {"ends": "face,round", TOLD: True}),
}
"""Title (beginning with the phantom's name) to how it is written and how it is measured."""

CLEAN = {"noise-free": {}, "turned by 17°": {"turn": 17.0}, "black plate": {"plate": "black"}}
CLEAN_BOUNDS = (0.15, 0.25)
REAL = {
    "realistic, white plate": {"realistic": True, "seed": 1, "suffix": "jpg", "plate": "white"},
    "realistic, black plate": {"realistic": True, "seed": 2, "suffix": "jpg", "plate": "black"},
}
REAL_BOUNDS = (0.5, 1.0)


def errors(folder, title, **look):
    """Errors of V and S in percent, signed."""
    body, options = BODIES[title]
    write_phantom(title.split(",")[0].split(" ")[0], "photos", folder, pixel_size=0.3, **body, **look)
    answer = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
    options = {**options, TOLD: answer["height"]} if TOLD in options else options
    found = stackloft.measure(folder, **options).objects[0]
    exact = [answer["volume"]["value"], answer["area"]["value"]]
    return (np.array([found.volume.value, found.area.value]) / exact - 1) * 100


@pytest.mark.parametrize(
    ("title", "look"),
    [
        ("ellipsoid, pose 2", "noise-free"),
        ("potato, seed 1", "turned by 17°"),
        ("banana", "noise-free"),
        ("box", "turned by 17°"),
        ("twisted-bar", "black plate"),
        ("meat", "noise-free"),
    ],
)
def test_noise_free_photographs(tmp_path, title, look):
    volume, area = abs(errors(tmp_path, title, **CLEAN[look]))
    assert volume <= CLEAN_BOUNDS[0]
    assert area <= CLEAN_BOUNDS[1]


@pytest.mark.parametrize("title", ["apple", "meat", "potato, seed 1"])
@pytest.mark.parametrize("look", REAL)
def test_realistic_photographs(tmp_path, title, look):
    volume, area = abs(errors(tmp_path, title, **REAL[look]))
    assert volume <= REAL_BOUNDS[0]
    assert area <= REAL_BOUNDS[1]


@pytest.mark.parametrize("title", ["potato, seed 1", "prism"])
def test_mirrored_pictures_and_a_turned_body(tmp_path, title):
    plain = errors(tmp_path / "plain", title)
    mirrored = errors(tmp_path / "mirrored", title, mirror=True)
    turned = errors(tmp_path / "turned", title, turn=31.0)
    np.testing.assert_allclose(mirrored, plain, atol=1e-3)  # percent: 1e-5
    assert abs(turned - plain)[0] <= 0.02
    assert abs(turned - plain)[1] <= 0.05


def _matrix(tmp_path, looks, bounds, proof, name, claim):
    rows, worst = [], np.zeros(2)
    for title in BODIES:
        for number, (look, options) in enumerate(looks.items()):
            found = errors(tmp_path / f"{title}-{number}", title, **options)
            worst = np.maximum(worst, abs(found))
            rows.append((title, look, f"{found[0]:+.3f}", f"{found[1]:+.3f}"))
    rows.append(("**worst**", "", f"{worst[0]:.3f}", f"{worst[1]:.3f}"))
    proof(name, claim, ("body", "pictures", "V error %", "S error %"), rows)
    assert (worst <= bounds).all()


@pytest.mark.prove
def test_every_body_noise_free(tmp_path, proof):
    claim = "0.3 mm noise-free photographs: V within 0.15 %, S within 0.25 %"
    _matrix(tmp_path, CLEAN, CLEAN_BOUNDS, proof, "loft-photographs", claim)


@pytest.mark.prove
def test_every_body_realistic(tmp_path, proof):
    claim = (
        "0.3 mm photographs with flesh, skin, noise, blur, uneven light, JPEG: V within 0.5 %, S within 1 %"
    )
    _matrix(tmp_path, REAL, REAL_BOUNDS, proof, "loft-photographs-realistic", claim)


@pytest.mark.prove
@pytest.mark.parametrize("plate", ["white", "black"])
def test_many_realistic_potatoes(tmp_path, proof, plate):
    found = []
    for seed in range(40):
        BODIES["potato many"] = ({"parameters": {"seed": seed}, "rotation": seed + 50}, {TOLD: True})
        look = {"realistic": True, "seed": seed, "suffix": "jpg", "plate": plate}
        found.append(errors(tmp_path / str(seed), "potato many", **look))
    worst, mean = abs(np.array(found)).max(axis=0), np.mean(found, axis=0)
    proof(
        f"loft-potatoes-{plate}",
        f"40 seeded potatoes in seeded poses, realistic photographs on a {plate} plate, height told",
        ("", "V error %", "S error %"),
        [("mean", *(f"{x:+.3f}" for x in mean)), ("worst", *(f"{x:.3f}" for x in worst))],
    )
    assert worst[0] <= REAL_BOUNDS[0]
    assert worst[1] <= REAL_BOUNDS[1]
