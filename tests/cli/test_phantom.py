"""``stackloft phantom`` writes a stack that ``stackloft measure`` measures to its exact answer."""

import json

import pytest

from stackloft.cli.arguments import PHANTOMS
from stackloft.testing.phantoms import NAMES


def error(stackloft, folder, quantity, *flags):
    run = stackloft("measure", folder, "--json", "--quiet", *flags)
    assert run.returncode == 0, run.stderr
    exact = json.loads((folder / "answer.json").read_text())[quantity]["value"]
    return json.loads(run.stdout)["objects"][0][quantity]["value"] / exact - 1


def test_the_help_names_every_phantom():
    assert set(PHANTOMS) == set(NAMES)


@pytest.mark.parametrize("form", ["photos", "contours"])
def test_a_written_phantom_is_measured_to_its_answer(stackloft, tmp_path, form):
    folder = tmp_path / "ellipsoid"
    run = stackloft("phantom", "ellipsoid", "--as", form, "-o", folder, "--set", "a=3cm", "--rotation", "7")
    assert run.returncode == 0, run.stderr
    assert "exact" in run.stdout
    assert abs(error(stackloft, folder, "volume")) < 0.0015
    assert abs(error(stackloft, folder, "area")) < 0.0025


def test_its_options_reach_it(stackloft, tmp_path):
    folder = tmp_path / "roast"
    flags = ["--sections", "5", "--placing", "faces", "--pixel-size", "1mm", "--realistic", "--seed", "3"]
    more = [
        "--plate",
        "white",
        "--suffix",
        "jpg",
        "--offset",
        "1,2,3mm",
        "--tell",
        "pixel_size,thickness,ends",
    ]
    run = stackloft("phantom", "meat", "--as", "photos", "-o", folder, *flags, *more)
    assert run.returncode == 0, run.stderr
    assert len(list(folder.glob("*.jpg"))) == 5
    assert "face" in (folder / "stack.toml").read_text()
    assert json.loads((folder / "answer.json").read_text())["offset"] == [1, 2, 3]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["ellipsoit", "--as", "photos"], "did you mean ellipsoid"),
        (["box", "--as", "dicon"], "photos, contours"),
        (["box", "--as", "photos", "--set", "width=3"], "a, b, c"),
        (["box", "--as", "photos", "--set", "a"], "a=30mm"),
        (["box", "--as", "photos", "--rotation", "1,x"], "degrees"),
        (["box", "--as", "contours", "--realistic"], "photos"),
        (["box", "--as", "photos", "--pixel-size", "3furlong"], "unknown unit"),
    ],
)
def test_wrong_usage_is_one_line(stackloft, tmp_path, arguments, words):
    run = stackloft("phantom", *arguments, "-o", tmp_path / "out")
    assert run.returncode == 2, run.stderr
    assert words in run.stderr
    assert run.stderr.count("\n") == 1
