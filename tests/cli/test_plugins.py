"""``stackloft plugins list`` and ``show``."""

import json
import os
import subprocess
import sys

import jsonschema
import pytest

from stackloft.testing.conformance.throwaway import write_distribution


def test_every_built_in_is_listed_and_sound(stackloft):
    rows = json.loads(stackloft("plugins", "list", "--json").stdout)
    own = {(row["family"], row["name"]) for row in rows if row["distribution"] == "stackloft"}
    for plugin in [("reader", "photos"), ("reconstructor", "loft"), ("writer", "ply"), ("recipe", "frustum")]:
        assert plugin in own
    assert {row["state"] for row in rows if row["distribution"] == "stackloft"} == {"ok"}


def test_the_table_has_a_line_for_each(stackloft):
    lines = stackloft("plugins", "list").stdout.splitlines()
    assert lines[0].split() == ["family", "name", "version", "distribution", "api", "state"]
    assert len(lines) - 1 == len(json.loads(stackloft("plugins", "list", "--json").stdout))


def test_show_gives_options_with_unit_bounds_default_and_source(stackloft):
    run = stackloft("plugins", "show", "reconstructor.loft")
    for word in ("points", "33", "≥ 5", "Goñi, Purlis & Salvadori (2007)", "height", "mm", "ContourStack"):
        assert word in run.stdout, word


def test_show_as_json_names_the_same_options(stackloft):
    (details,) = json.loads(stackloft("plugins", "show", "writer.stl", "--json").stdout)
    (option,) = details["options"]
    assert (option["name"], option["unit"], option["bounds"]) == ("tolerance", "mm", {"gt": 0})
    jsonschema.Draft202012Validator.check_schema(details["schema"])
    jsonschema.validate({"tolerance": option["default"]}, details["schema"])
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"treshold": 0.1}, details["schema"])


def test_a_name_in_several_families_shows_all_of_them(stackloft):
    rows = json.loads(stackloft("plugins", "show", "loft", "--json").stdout)
    assert {row["family"] for row in rows} == {"reconstructor", "recipe"}


def test_an_unknown_name_is_one_line_with_the_nearest(stackloft):
    run = stackloft("plugins", "show", "hystogram")
    assert run.returncode == 1
    assert run.stderr == "stackloft: no plug-in is called 'hystogram'; fix: did you mean histogram?\n"


def test_list_tells_api_version_and_state_and_imports_no_plugin(tmp_path):
    """The row of a package that would crash the process is there, because nothing of it is imported."""
    site = write_distribution(
        tmp_path,
        "acme-xct",
        {"stackloft.readers": {"acme": "acme_xct:Reader", "old": "acme_xct:Gone"}},
        {"acme_xct": "import os\nos.abort()\nclass Reader:\n    api = '2'\n"},
    )
    code = (
        "import sys; from stackloft.cli import main\n"
        "sys.argv = ['stackloft', 'plugins', 'list', '--json']\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "heavy = ['numpy', 'scipy', 'stackloft_plugins', 'acme_xct']\n"
        "print([name for name in heavy if name in sys.modules], file=sys.stderr)\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(site)},
    )
    assert set(run.stderr.splitlines()) == {"[]"}  # the command and the process that looks after it
    rows = {row["name"]: row for row in json.loads(run.stdout)}
    assert (rows["acme"]["api"], rows["acme"]["state"]) == ("2", "refused")
    assert rows["acme"]["reason"] == "api 2 does not fit this stackloft's contract 1"
    assert rows["old"]["state"] == "stale"
    assert (rows["photos"]["api"], rows["photos"]["state"]) == ("1", "ok")


def test_show_names_the_source_and_an_example(stackloft):
    (details,) = json.loads(stackloft("plugins", "show", "integrator.cavalieri", "--json").stdout)
    assert details["source"].endswith("integrators/cavalieri.py")
    assert details["example"].startswith("stackloft measure SOURCE --method cavalieri --set ")
    assert f"example: {details['example']}" in stackloft("plugins", "show", "integrator.cavalieri").stdout


def test_the_examples_shown_are_understood(stackloft, ball_folder):
    """What `show` prints is really run."""
    for name in ("integrator.cavalieri", "segmenter.histogram"):
        (details,) = json.loads(stackloft("plugins", "show", name, "--json").stdout)
        words = details["example"].replace("SOURCE", str(ball_folder)).split()[1:]
        run = stackloft(*words, "--json")
        assert run.returncode == 0, (name, run.stderr)


def test_show_survives_a_plugin_that_crashes_the_process(stackloft, tmp_path):
    site = write_distribution(
        tmp_path,
        "acme-crash",
        {"stackloft.readers": {"acme": "acme_crash:Reader"}},
        {"acme_crash": "import os\nos.abort()\n"},
    )
    run = stackloft("plugins", "show", "acme", env={**os.environ, "PYTHONPATH": str(site)})
    assert run.returncode == 0
    assert "quarantined: loading it crashed the process (SIGABRT)" in run.stdout
    assert "acme-crash 1.0" in run.stdout
