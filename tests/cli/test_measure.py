"""``stackloft measure`` from the outside: figures, files, streams, exit status."""

import csv
import json
import math
import shutil
from pathlib import Path

import jsonschema
import meshio
import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).parents[2]
BALL = 4 / 3 * math.pi * 20**3, 4 * math.pi * 20**2


@pytest.fixture(scope="module")
def run_folder(stackloft, ball_folder, tmp_path_factory):
    """Return a folder that one whole run has filled, and what the run printed."""
    out = tmp_path_factory.mktemp("runs") / "new" / "out"
    run = stackloft(
        "measure", ball_folder, "--out", out, "--write", "stl,ply", "--method", "loft,cavalieri,frustum"
    )
    assert run.returncode == 0, run.stderr
    return out, run


def test_json_keeps_to_the_schema_and_is_all_that_stdout_gets(stackloft, ball_folder):
    run = stackloft("measure", ball_folder, "--json")
    assert run.returncode == 0, run.stderr
    document = json.loads(run.stdout)
    schema = json.loads((ROOT / "docs" / "measurement.schema.json").read_text())
    jsonschema.Draft202012Validator(schema).validate(document)
    (body,) = document["objects"]
    assert body["volume"]["value"] == pytest.approx(BALL[0], rel=5e-3)
    assert body["area"]["value"] == pytest.approx(BALL[1], rel=5e-3)
    assert len(body["sections"]) == 9
    assert "volume" in run.stderr, "the table is for people: on stderr"


def test_quiet_json_leaves_stderr_to_warnings(stackloft, ball_folder):
    run = stackloft("measure", ball_folder, "--json", "--quiet")
    warnings = json.loads(run.stdout)["warnings"]
    assert run.stderr.splitlines() == [f"stackloft: {x['code']}: {x['message']}" for x in warnings]


def test_the_table_reads_at_a_glance(run_folder):
    _, run = run_folder
    assert "cm³" in run.stdout
    assert "cm²" in run.stdout
    for word in (
        "volume",
        "area",
        "sphericity",
        "equivalent diameter",
        "first end",
        "last end",
        "cavalieri",
        "frustum",
    ):
        assert word in run.stdout, word
    assert run.stderr == "", "no progress where nobody watches"


PICTURES = ("overview.png", "figure_slice.png", "views.png")


def test_the_folder_holds_every_file_whole_and_nothing_else(run_folder):
    out, run = run_folder
    names = {"measurement.json", "recipe.toml", "sections.csv", *PICTURES, "solid.stl", "solid.ply"}
    assert {path.name for path in out.iterdir()} == names
    for name in names:
        assert str(out / name) in run.stdout


def test_the_files_agree_with_each_other(run_folder):
    out, _ = run_folder
    (body,) = json.loads((out / "measurement.json").read_text())["objects"]
    with (out / "sections.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [float(row["area [mm^2]"]) for row in rows] == [row["area"] for row in body["sections"]]
    for name in ("solid.ply", "solid.stl"):
        mesh = meshio.read(out / name)
        a, b, c = (mesh.points[mesh.cells_dict["triangle"][:, k]].astype(float) for k in range(3))
        volume = float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)
        assert volume == pytest.approx(body["volume"]["value"], rel=5e-3)
    for name in PICTURES:
        with Image.open(out / name) as picture:
            assert picture.size[0] > 3 * 130
            assert len(picture.convert("RGB").getcolors(1 << 24)) > 50, f"{name} shows something"


def test_a_scan_has_its_pictures_too_and_a_method_without_a_solid_no_views(stackloft, tmp_path):
    z, y, x = np.mgrid[:12, :48, :64]
    ball = (x - 30) ** 2 + (y - 22) ** 2 + (2 * z - 11) ** 2 < 100
    np.savez(tmp_path / "ball.npz", ball * 1000.0 - 400, spacing=[2.0, 1.0, 1.0])
    arguments = ("measure", tmp_path / "ball.npz", "--method", "cavalieri", "--figure-slice", "6", "--quiet")
    run = stackloft(*arguments, "--out", tmp_path / "out")
    assert run.returncode == 0, run.stderr
    pictures = {path.name for path in (tmp_path / "out").glob("*.png")}
    assert pictures == {"overview.png", "figure_slice.png"}


def test_a_figure_of_a_slice_that_is_not_there_is_wrong_usage(stackloft, ball_folder, tmp_path):
    run = stackloft("measure", ball_folder, "--out", tmp_path / "out", "--figure-slice", "10")
    assert run.returncode == 2
    assert "--figure-slice: no such slice; found: 10; expected: a number from 1 to 9" in run.stderr
    assert list((tmp_path / "out").iterdir()) == []
    alone = stackloft("measure", ball_folder, "--figure-slice", "2")
    assert (alone.returncode, "give --out DIR" in alone.stderr) == (2, True)


def test_the_recipe_run_again_gives_the_same_figures_to_the_bit(stackloft, ball_folder, run_folder):
    out, _ = run_folder
    again = stackloft("measure", ball_folder, "--recipe", out / "recipe.toml", "--json", "--quiet")
    first = json.loads((out / "measurement.json").read_text())["objects"][0]
    second = json.loads(again.stdout)["objects"][0]
    for quantity in ("volume", "area"):
        assert second[quantity]["value"] == first[quantity]["value"]


@pytest.mark.parametrize(("unit", "volume"), [("mm", "mm³"), ("in", "in³"), ("m", "m³"), ("um", "µm³")])
def test_units_are_those_of_the_table_alone(stackloft, ball_folder, unit, volume):
    run = stackloft("measure", ball_folder, "--units", unit)
    assert f" {volume}" in run.stdout
    assert (
        json.loads(stackloft("measure", ball_folder, "--units", unit, "--json").stdout)["objects"][0][
            "volume"
        ]["unit"]
        == "mm^3"
    )


def test_flags_win_over_the_folder(stackloft, ball_folder):
    plain, scaled = (
        json.loads(stackloft("measure", ball_folder, "--json", *flags).stdout)["objects"][0]["sections"][4][
            "area"
        ]
        for flags in ([], ["--pixel-size", "0.1cm"])
    )
    assert scaled == pytest.approx(4 * plain, rel=1e-9)


def test_a_writers_own_option_reaches_it(stackloft, ball_folder, tmp_path):
    sizes = []
    for tolerance in ("0.02mm", "0.5mm"):
        out = tmp_path / tolerance
        run = stackloft(
            "measure", ball_folder, "--out", out, "--write", "ply", "--set", f"ply.tolerance={tolerance}"
        )
        assert run.returncode == 0, run.stderr
        sizes.append((out / "solid.ply").stat().st_size)
    assert sizes[0] > 2 * sizes[1]


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["no-such-folder"], 1, "no such file or folder"),
        (["BALL", "--pixel-size", "5parsec"], 2, "unknown unit"),
        (["BALL", "--set", "nonsense"], 2, "family.option=value"),
        (["BALL", "--set", "segmenter.tresholt=otsu"], 2, "threshold"),
        (["BALL", "--ends", "square"], 2, "face"),
        (["BALL", "--method", "lofd"], 1, "did you mean loft"),
        (["BALL", "--write", "stl"], 2, "--out"),
        (["BALL", "--out", "OUT", "--write", "json"], 2, "writes no solid"),
        (["BALL", "--out", "OUT", "--write", "stlx"], 1, "did you mean stl"),
        (["BALL", "--out", "OUT", "--set", "stl.tolerance=1"], 2, "--write stl"),
        (["BALL", "--out", "OUT", "--method", "cavalieri", "--write", "stl"], 1, "no solid"),
        (["BALL", "--out", "BALL"], 2, "another folder"),
        (["BALL", "--recipe", "BALL/cut_1.png"], 1, "cut_1.png"),
        (["BALL", "--points", "2"], 2, "points"),
    ],
)
def test_what_is_wrong_is_one_line_with_its_exit_status(
    stackloft, ball_folder, tmp_path, arguments, status, words
):
    texts = [
        text.replace("BALL", str(ball_folder)).replace("OUT", str(tmp_path / "out")) for text in arguments
    ]
    run = stackloft("measure", *texts)
    assert run.returncode == status, run.stderr
    assert words in run.stderr
    assert run.stderr.startswith("stackloft: ")
    assert run.stderr.count("\n") == 1
    assert run.stdout == ""


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda folder: [path.unlink() for path in folder.iterdir()], "empty folder"),
        (lambda folder: (folder / "stack.toml").unlink(), "--pixel-size"),
        (lambda folder: [(folder / f"cut_{k}.png").unlink() for k in range(2, 10)], "cut_1.png"),
        (
            lambda folder: (folder / "cut_3.png").write_bytes((folder / "cut_3.png").read_bytes()[:200]),
            "cut_3.png",
        ),
        (lambda folder: Image.new("L", (64, 64), 255).save(folder / "cut_4.png"), "cut_4.png"),
        (lambda folder: Image.new("L", (130, 110), 230).save(folder / "cut_5.png"), "cut_5.png"),
    ],
    ids=["empty folder", "no spacing", "one slice", "damaged picture", "another size", "no body"],
)
def test_an_input_that_cannot_be_measured_names_the_file_and_the_fix(
    stackloft, ball_folder, tmp_path, spoil, words
):
    folder = tmp_path / "spoiled"
    shutil.copytree(ball_folder, folder)
    spoil(folder)
    out = tmp_path / "out"
    run = stackloft("measure", folder, "--out", out)
    assert run.returncode == 1, run.stdout
    assert words in run.stderr
    assert "Traceback" not in run.stderr
    assert run.stderr.count("\n") == 1
    assert list(out.iterdir()) == []
