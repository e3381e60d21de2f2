"""``stackloft phantom`` writes a stack that ``stackloft measure`` measures to its exact answer."""

import json

import pytest

from stackloft.cli.phantom_arguments import PHANTOMS
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


def test_a_scan_takes_all_that_the_scanner_can_do(stackloft, tmp_path):
    folder = tmp_path / "scan"
    text = "--tilt -12 --cosines 7 --origin -100,20.5,3cm --noise 9 --levels -1000,60 --syntax rle --empty 2"
    text += (
        " --sections 9 --aspect 3 --fill 0.5 --bias 0.1 --margin 5mm --stretch 1.25 --slab-points 2 --seed 4"
    )
    flags = text.split()
    run = stackloft("phantom", "ellipsoid", "--as", "dicom", "-o", folder, *flags)
    assert run.returncode == 0, run.stderr
    facts = json.loads(stackloft("info", folder, "--json").stdout)
    pitch = facts["pitch"][0]
    assert facts["slices"] == 13
    assert facts["pixel_size"]["column"][0] == pytest.approx(pitch / 3)
    assert facts["pixel_size"]["row"][0] == pytest.approx(1.25 * pitch / 3)
    assert facts["thickness"][0] == pytest.approx(0.5 * pitch)
    assert {"tilt", "slab-gaps"} <= {hazard["code"] for hazard in facts["hazards"]}
    assert abs(facts["affine"][2][0]) > 0.01
    assert abs(error(stackloft, folder, "volume")) < 0.05


@pytest.mark.parametrize("form", ["dicom-seg", "bruker", "rtstruct", "nifti"])
def test_every_form_of_scan_is_written_and_read(stackloft, tmp_path, form):
    run = stackloft(
        "phantom", "cone", "--as", form, "-o", tmp_path / form, "--sections", "6", "--cosines", "3"
    )
    assert run.returncode == 0, run.stderr
    source = tmp_path / form / "scan.nii.gz" if form == "nifti" else tmp_path / form
    facts = json.loads(stackloft("info", source, "--json").stdout)
    assert facts["reader"] == {"nifti": "itk"}.get(form, form)
    assert len(facts["affine"]) == 4


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        (["--as", "nrrd", "--tilt", "5"], "nrrd cannot hold a sheared grid"),
        (["--as", "dicom", "--levels", "5"], "not two grey levels"),
        (["--as", "dicom", "--origin", "5,6"], "not a place in space"),
        (["--as", "dicom", "--aspect", "0"], "must be above 0"),
        (["--as", "dicom", "--syntax", "morse"], "unknown transfer syntax"),
        (["--as", "photos", "--tilt", "5"], "unknown option tilt"),
    ],
)
def test_what_a_scanner_cannot_do_is_said(stackloft, tmp_path, flags, words):
    run = stackloft("phantom", "cone", "-o", tmp_path / "x", *flags)
    assert run.returncode == 2
    assert words in run.stderr
