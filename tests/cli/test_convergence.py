"""``stackloft convergence`` on photographs: tables, JSON, files, answers."""

import csv
import json

import pytest
from PIL import Image


def test_tables_and_answers(stackloft, ball_folder):
    run = stackloft("convergence", ball_folder, "--tolerance", "2%")
    assert run.returncode == 0, run.stderr
    assert "points per section suffice for ±2 %" in run.stdout
    assert "sections suffice for ±2 %" in run.stdout
    assert "400" in run.stdout


def test_json_alone_on_stdout_and_whole_files(stackloft, ball_folder, tmp_path):
    out = tmp_path / "out"
    run = stackloft("convergence", ball_folder, "--json", "--quiet", "--tolerance", "1%", "--out", out)
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found["schema"] == "stackloft.convergence/1"
    assert found == json.loads((out / "convergence.json").read_text())
    assert found["suffices"]["tolerance"] == 1.0
    assert [row["sections"] for row in found["by_sections"]] == list(range(2, 10))
    counts = {"figure_06_points": 17, "figure_07_sections": 8, "figure_08_error": 25}
    for name, rows in counts.items():
        assert len(list(csv.reader((out / f"{name}.csv").read_text().splitlines()))) == rows + 1
        with Image.open(out / f"{name}.png") as picture:
            assert min(picture.size) > 300


@pytest.mark.parametrize("tolerance", ["0.5", "%", "-1%", "x%", "1%%", "nan%", "inf%"])
def test_a_tolerance_is_a_percentage(stackloft, ball_folder, tolerance):
    run = stackloft("convergence", ball_folder, f"--tolerance={tolerance}")
    assert run.returncode == 2
    assert "--tolerance: not a percentage" in run.stderr


def test_the_source_is_not_written_into(stackloft, ball_folder):
    run = stackloft("convergence", ball_folder, "--out", ball_folder)
    assert run.returncode == 2
    assert "is the source itself" in run.stderr
