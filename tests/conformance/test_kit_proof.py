"""How many seeded faults each family's kit catches, and how many checks hold on every built-in."""

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from stackloft.registry import catalogue
from stackloft.registry.child import ask_child
from stackloft.testing.conformance.check import NOT_HELD

HERE = Path(__file__).parent
FAMILIES = {
    "reader": ("test_reader_kit.py", "test_told_kit.py"),
    "segmenter": ("test_segmenter_kit.py",),
    "reconstructor": ("test_reconstructor_kit.py",),
    "mesher": ("test_mesher_kit.py",),
    "integrator": ("test_integrator_kit.py",),
    "writer": ("test_writer_kit.py",),
}


@pytest.mark.prove
def test_at_least_57_of_60_seeded_faults_are_caught(tmp_path, proof):
    rows, missed = [], []
    for family, files in FAMILIES.items():
        there = [str(HERE / name) for name in files if (HERE / name).exists()]
        if not there:
            continue
        report = tmp_path / f"{family}.xml"
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            "-k",
            "seeded_faults",
            f"--junitxml={report}",
            *there,
        ]
        subprocess.run(command, capture_output=True, check=False, cwd=HERE.parents[1])
        cases = list(ET.parse(report).iter("testcase"))
        lost = [case.get("name") for case in cases if len(case)]
        missed += lost
        rows.append((family, len(cases), len(cases) - len(lost), ", ".join(lost) or "–"))
    seeded = sum(row[1] for row in rows)
    caught = sum(row[2] for row in rows)
    rows.append(("**all**", seeded, caught, ""))
    assert seeded >= 60
    assert caught / seeded >= 0.95, missed
    proof(
        "plugin-kit-faults",
        "Seeded faults that the conformance kit catches",
        ("family", "seeded", "caught", "not caught"),
        rows,
    )


@pytest.mark.prove
def test_every_built_in_holds(proof):
    rows = []
    for listing in catalogue():
        if listing.distribution != "stackloft":
            continue
        answer = ask_child("stackloft.cli.plugin_check:examined", listing.key, 1800)
        assert not answer.fault, (listing.key, answer.stderr)
        found = answer.value["findings"]
        posed = [x for x in found if not x["reason"].startswith(NOT_HELD)]
        expected = [f"{x['check']}: {x['reason']}" for x in posed if x["passed"] and x["reason"]]
        broken = [x for x in found if not x["passed"]]
        assert not broken, (listing.key, broken)
        rows.append((listing.key, len(posed), len(found) - len(posed), "; ".join(expected) or "–"))
    header = ("plug-in", "checks that hold", "not posed", "expected failures among them")
    proof("plugin-kit", "The conformance kit on every built-in plug-in", header, rows)
