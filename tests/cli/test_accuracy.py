"""``stackloft accuracy`` shows errors, orders and failures, and leaves its files."""

import csv
import json

import pytest
from PIL import Image


def test_tables_json_and_files(stackloft, tmp_path):
    out = tmp_path / "out"
    flags = ("--quick", "--body", "cone", "--axis", "sections,points", "--method", "loft,cavalieri,frustum")
    run = stackloft("accuracy", *flags, "--json", "--out", out)
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found == json.loads((out / "accuracy.json").read_text())
    assert found["schema"] == "stackloft.accuracy/1"
    assert {row["method"] for row in found["rows"]} == {"loft", "cavalieri", "frustum"}
    assert "V order" in run.stderr
    rows = list(csv.DictReader((out / "accuracy.csv").read_text().splitlines()))
    assert len(rows) == len(found["rows"]) == 3 * 4
    assert [row["failure"] != "" for row in rows if row["axis"] == "points"].count(True) == 4
    assert len(list(csv.reader((out / "orders.csv").read_text().splitlines()))) == 1 + 4
    with Image.open(out / "heat_map.png") as picture:
        assert min(picture.size) > 300


def test_cavalieri_s_error_stands_beside_theory_s(stackloft):
    run = stackloft("accuracy", "--quick", "--body", "ellipsoid 1:1:0.5", "--axis", "sections",
                    "--method", "cavalieri")  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert run.stdout.count("+1.02041") == 2
    assert run.stdout.count("+0.25510") == 2


@pytest.mark.parametrize(
    ("flags", "status", "words"),
    [
        (["--body", "potatoe"], 2, "did you mean potato"),
        (["--axis", "section"], 2, "did you mean sections"),
        (["--method", "lofd"], 1, "loft"),
    ],
)
def test_wrong_usage_is_one_line(stackloft, flags, status, words):
    run = stackloft("accuracy", "--quick", *flags)
    assert run.returncode == status, run.stderr
    assert words in run.stderr
    assert run.stderr.count("\n") == 1
