"""``docs/writing-a-plugin.md`` is done from the document alone, and its result is the worked package."""

import json
import re
import shutil
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "writing-a-plugin.md").read_text(encoding="utf-8")
WORKED = ROOT / "tests" / "fixtures" / "acme-xct"
STEP = re.compile(
    r"<!-- file: (?P<path>\S+) -->\n```python\n(?P<text>.*?)```|```sh\n(?P<commands>.*?)```", re.DOTALL
)
FILES = {match["path"]: match["text"] for match in STEP.finditer(PAGE) if match["path"]}


@pytest.mark.parametrize("path", FILES)
def test_the_files_shown_are_those_of_the_worked_package(path):
    assert FILES[path] == (WORKED / path).read_text(encoding="utf-8")


@pytest.mark.prove
def test_every_command_of_the_page_runs_in_an_empty_environment(lab, tmp_path, proof):
    folder, told, start = tmp_path, {}, time.perf_counter()
    for step in STEP.finditer(PAGE):
        if step["path"]:
            (folder / step["path"]).write_text(step["text"], encoding="utf-8")
            continue
        for line in step["commands"].splitlines():
            if line.startswith("cd "):
                folder = (folder / line.removeprefix("cd ")).resolve()
            else:
                told[line] = lab.sh(line, folder)
    seconds = time.perf_counter() - start
    figures = json.loads(told["stackloft measure sample.xct --method all --json --set acme-xct.pitch=1.5mm"])
    volume = figures["objects"][0]["volume"]["value"]
    assert figures["source"]["reader"] == "acme-xct"
    assert abs(volume / 8682.0 - 1) < 0.02
    assert "23 of 23 checks hold" in told["stackloft plugins check acme-xct"]
    assert "0 broken" in told["stackloft plugins doctor acme-xct acme-simpson"]
    header, row = (
        ("commands", "seconds", "volume of the ball [mm³]"),
        (len(told), f"{seconds:.0f}", f"{volume:.1f}"),
    )
    proof(
        "writing-a-plugin", "The walk-through, by its commands alone, in an empty environment", header, [row]
    )


def test_the_worked_package_is_really_installed_and_measures(lab, tmp_path):
    lab.sh(f"pip install -q --no-build-isolation --no-deps {copied(tmp_path)}", tmp_path)
    rows = json.loads(lab.sh("stackloft plugins list --json", tmp_path))
    (row,) = [row for row in rows if row["distribution"] == "acme-xct"]
    assert (row["family"], row["name"], row["api"], row["state"]) == ("reader", "acme-xct", "1", "ok")
    code = "from pathlib import Path; from acme_xct.conformance import write_sample; write_sample(Path(), 17)"
    lab.sh(f'python -c "{code}"', tmp_path)
    figures = json.loads(lab.sh("stackloft measure sample.xct --json", tmp_path))
    assert abs(figures["objects"][0]["volume"]["value"] / 8682.0 - 1) < 0.02
    assert "23 of 23 checks hold" in lab.sh("stackloft plugins check acme-xct", tmp_path)


def copied(folder):
    """Return a copy of the worked package: building must leave nothing in the tree."""
    return shutil.copytree(WORKED, folder / "worked")
