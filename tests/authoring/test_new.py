"""``stackloft plugins new``: each family's package is green at once, without network."""

import json

import pytest

from stackloft.cli.plugin_new import families

INVENTED = {
    "self.pitch or pitch\n": "self.pitch or pitch or 1.0\n",
    "min(pitch, row, column) > 0": "pitch > 0",
    "np.tile((row, column)": "np.tile((row or 1.0, column or 1.0)",
}
"""A spacing of 1 where the file tells none."""
INSTALL = "pip install -q --no-build-isolation --no-deps -e ."


def test_every_family_that_has_a_product_has_a_template():
    assert families() == ("reader", "segmenter", "reconstructor", "mesher", "integrator", "writer", "recipe")


QUICK = ("reader", "integrator")
SHOWN = [
    family if family in QUICK else pytest.param(family, marks=pytest.mark.prove) for family in families()
]


@pytest.mark.parametrize("family", SHOWN)
def test_a_new_package_is_green_at_once(lab, tmp_path, family):
    name = f"acme-{family}"
    assert f"cd {name}" in lab.sh(f"stackloft plugins new {family} {name}", tmp_path)
    folder = tmp_path / name
    lab.sh(INSTALL, folder)
    assert "passed" in lab.sh("pytest -q -W error", folder)
    rows = {(x["family"], x["name"]): x for x in json.loads(lab.sh("stackloft plugins list --json", folder))}
    row = rows[family, name]
    assert (row["distribution"], row["version"], row["api"], row["state"]) == (name, "0.1.0", "1", "ok")
    if family == "reader":
        return  # its own format: see below
    use = next(line.strip() for line in (folder / "README.md").read_text().splitlines() if "SOURCE" in line)
    kind = "photos --pixel-size 0.5mm" if family == "segmenter" else "contours"
    lab.sh(f"stackloft phantom potato --as {kind} -o stack", tmp_path)
    run = f"{use.replace('SOURCE', 'stack')} --json --quiet"
    body = json.loads(lab.sh(run, tmp_path))["objects"][0]
    answer = json.loads((tmp_path / "stack" / "answer.json").read_text())
    assert body["volume"]["value"] == pytest.approx(answer["volume"]["value"], rel=0.05)
    if family == "writer":
        assert [path for path in (tmp_path / "RUN").iterdir() if "solid" in path.stem]


def test_a_new_reader_works_in_measure_and_its_check_is_a_table(lab, tmp_path):
    lab.sh("stackloft plugins new reader acme-xct --out 'my reader'", tmp_path)
    folder = tmp_path / "my reader"
    lab.sh(INSTALL, folder)
    code = "import pathlib; from acme_xct.conformance import write_sample; write_sample(pathlib.Path('.'), 9)"
    lab.sh(f'python -c "{code}"', folder)
    result = json.loads(lab.sh("stackloft measure sample.vol --json --set acme-xct.pitch=3mm", folder))
    assert result["source"]["reader"] == "acme-xct"
    assert abs(result["objects"][0]["volume"]["value"] / (2 * 1287.8) - 1) < 0.1
    shown = lab.sh("stackloft plugins show acme-xct", folder)
    assert "slice spacing to use instead of the file's" in shown
    table = lab.sh("stackloft plugins check acme-xct", folder)
    assert table.splitlines()[0].split() == ["check", "outcome", "reason"]
    assert "23 of 23 checks hold" in table
    unknown = lab.sh("stackloft measure sample.vol --set acme-xct.pitches=3mm", folder, status=2)
    assert "did you mean pitch?" in unknown


def test_a_fault_in_the_plugin_fails_its_check(lab, tmp_path):
    lab.sh("stackloft plugins new reader acme-xct", tmp_path)
    folder = tmp_path / "acme-xct"
    lab.sh(INSTALL, folder)
    source = folder / "src" / "acme_xct" / "plugin.py"
    text = source.read_text()
    for honest, faulty in INVENTED.items():
        assert honest in text
        text = text.replace(honest, faulty)
    source.write_text(text)
    report = lab.sh("stackloft plugins check reader.acme-xct --json", folder, status=1)
    told = json.loads(report[report.index("{") :])
    failed = [item["check"] for item in told["checks"] if not item["passed"]]
    assert not told["passed"]
    assert failed == ["refuses-unknown-spacing"]
    source.write_text("import os\nos.abort()\n")
    assert "crashed the process (SIGABRT)" in lab.sh("stackloft plugins check acme-xct", folder, status=1)
    assert "acme-xct" in lab.sh("stackloft plugins list", folder)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("readr acme-xct", "did you mean reader"),
        ("mesh acme-mesh", "did you mean mesher"),
        ("reader Acme_XCT", "is no name for a plug-in"),
        ("reader json", "would hide the package json"),
        ("reader dicom", "stackloft already has a reader 'dicom'"),
    ],
)
def test_what_cannot_be_begun_is_wrong_usage(lab, tmp_path, arguments, words):
    assert words in lab.sh(f"stackloft plugins new {arguments}", tmp_path, status=2)


def test_nothing_is_written_over(lab, tmp_path):
    (tmp_path / "acme-xct").mkdir()
    (tmp_path / "acme-xct" / "thesis.txt").write_text("the only copy")
    assert "not empty" in lab.sh("stackloft plugins new reader acme-xct", tmp_path, status=1)
    assert [path.name for path in (tmp_path / "acme-xct").iterdir()] == ["thesis.txt"]
