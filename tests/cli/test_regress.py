"""``stackloft regress`` prints the paper's figures and leaves its pictures."""

import csv
import json
from pathlib import Path

import pytest
from PIL import Image

TABLE = Path(__file__).parents[2] / "sample_stacks" / "goni2007_table1.csv"


def test_the_table_has_the_paper_s_figures(stackloft):
    run = stackloft("regress", TABLE)
    assert run.returncode == 0, run.stderr
    for figure in ("1.95", "1.69", "1.36", "-1.25", "-1.01", "-0.95", "0.9917", "0.9978", "0.9954", "6.1117",
                   "5.6312", "6.1068", "5.0085", "5.0961", "6.3729", "0.9336", "0.9644"):  # fmt: skip
        assert figure in run.stdout


def test_json_is_alone_on_stdout_and_the_files_are_whole(stackloft, tmp_path):
    out = tmp_path / "out"
    run = stackloft("regress", TABLE, "--json", "--out", out)
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found["schema"] == "stackloft.regression/1"
    assert found == json.loads((out / "regression.json").read_text())
    assert found["groups"][0]["area_by_weight"]["coefficient"] == pytest.approx(6.1117, abs=5e-5)
    for name in ("figure_09_area_weight", "figure_10_area_volume"):
        assert len(list(csv.reader((out / f"{name}.csv").read_text().splitlines()))) == 21
        with Image.open(out / f"{name}.png") as picture:
            assert min(picture.size) > 400
            assert picture.convert("L").getextrema()[0] < 128


def test_a_bad_table_is_one_line_with_row_and_column(stackloft, tmp_path):
    bad = tmp_path / "bad.csv"
    bad.write_text(TABLE.read_text().replace("242.7", "24Z.7"))
    run = stackloft("regress", bad)
    assert run.returncode == 1
    assert run.stderr.count("\n") == 1
    assert "row 4, column 'weight_g': not a number" in run.stderr


def test_group_names_are_no_formulas(stackloft, tmp_path):
    odd = tmp_path / "odd.csv"
    odd.write_text(
        TABLE.read_text().replace("Meat piece", "_x^{ $2 and $3").replace("Granny Smith", "[red]G")
    )
    run = stackloft("regress", odd, "--out", tmp_path / "out")
    assert run.returncode == 0, run.stderr
    assert "[red]G" in run.stdout
