"""``stackloft plugins doctor``: what is broken is named with its fix, and takes nothing with it."""

import json
import os
import subprocess
import sys
from importlib.metadata import Distribution

import pytest

from stackloft.cli.doctor import codecs, kernels, libraries, rendering
from stackloft.cli.doctor.entry_points import stale_entry_points
from stackloft.registry.child import Answer
from stackloft.testing.conformance.throwaway import write_distribution

GOOD = """
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar
@dataclass(frozen=True)
class Reader:
    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = ()
    def probe(self, path): return 0.0
    def read(self, path): raise NotImplementedError
"""
STRANGERS = {
    "good": (GOOD, "ok", ""),
    "newer": (GOOD.replace('"1"', '"1.4"'), "warning", "is written for contract 1.4"),
    "older": (GOOD.replace('"1"', '"2"'), "broken", "api 2 does not fit this stackloft's contract 1"),
    "aborts": ("import os\nos.abort()", "broken", "crashed the process (SIGABRT)"),
    "segfaults": ("import ctypes\nctypes.string_at(0)", "broken", "crashed the process (SIGSEGV)"),
    "leaves": ("import os\nos._exit(0)", "broken", "left the process with status 0"),
    "imports": ("def deep():\n    import acme_codec\ndeep()", "broken", "No module named 'acme_codec'"),
    "probes": (GOOD.replace("return 0.0", "1 / 0"), "broken", "ZeroDivisionError"),
    "prints": (f"print('{{}}')\n{GOOD}", "ok", ""),
}


@pytest.fixture(scope="module")
def rows(stackloft, tmp_path_factory):
    """The doctor's rows on nine strangers, by name, and its exit status."""
    site = tmp_path_factory.mktemp("site")
    for name, (source, _, _) in STRANGERS.items():
        module = f"acme_{name}"
        groups = {"stackloft.readers": {name: f"{module}:Reader"}}
        write_distribution(site, f"acme-{name}", groups, {module: source})
    run = stackloft("plugins", "doctor", *STRANGERS, "--json", env={**os.environ, "PYTHONPATH": str(site)})
    return run.returncode, {row["name"].removeprefix("reader."): row for row in json.loads(run.stdout)}


@pytest.mark.parametrize("name", STRANGERS)
def test_each_stranger_is_loaded_alone_and_told_of(rows, name):
    _, state, words = STRANGERS[name]
    row = rows[1][name]
    assert row["state"] == state
    assert words in row["detail"]
    assert f"acme-{name} 1.0" in row["detail"]


def test_a_failed_import_comes_with_its_traceback_and_pip_line(rows):
    row = rows[1]["imports"]
    assert "in deep" in row["traceback"]
    assert row["fix"] == "python -m pip install acme_codec"


def test_something_broken_is_exit_status_1(rows, stackloft):
    assert rows[0] == 1
    run = stackloft("plugins", "doctor", "voxel")
    assert run.returncode == 0
    assert run.stdout.endswith("2 looked at, 0 broken\n")


def editable(tmp_path, declared, installed):
    folder = tmp_path / "a b"
    folder.mkdir()
    lines = "".join(f'{name} = "{target}"\n' for name, target in declared.items())
    (folder / "pyproject.toml").write_text(
        f'[project]\nname = "acme"\n[project.entry-points."stackloft.readers"]\n{lines}'
    )
    site = write_distribution(tmp_path / "site", "acme", {"stackloft.readers": installed}, {})
    info = next(site.glob("*.dist-info"))
    origin = {"url": folder.as_uri(), "dir_info": {"editable": True}}
    (info / "direct_url.json").write_text(json.dumps(origin))
    return folder, [Distribution.at(info)]


def test_entry_points_gone_stale_since_the_install_are_named_with_the_line_that_helps(tmp_path):
    folder, found = editable(tmp_path, {"new": "acme:New"}, {"old": "acme:Old"})
    (row,) = stale_entry_points(found)
    assert row.state == "broken"
    assert "in pyproject.toml but not installed: stackloft.readers new = acme:New" in row.detail
    assert "no longer in pyproject.toml: stackloft.readers old = acme:Old" in row.detail
    assert row.fix == f"python -m pip install --no-build-isolation --no-deps -e {folder}"


def test_entry_points_as_declared_are_fine(tmp_path):
    _, found = editable(tmp_path, {"a": "acme:A"}, {"a": "acme:A"})
    assert [row.state for row in stale_entry_points(found)] == ["ok"]


def test_every_transfer_syntax_of_the_card_is_told_of():
    rows = {row.name: row for row in codecs.transfer_syntaxes()}
    assert {f"1.2.840.10008.1.2.4.{last}" for last in codecs.PACKAGES} <= set(rows)
    assert {"1.2.840.10008.1.2.1", "1.2.840.10008.1.2.5"} <= set(rows)
    assert {row.state for row in rows.values()} == {"ok"}


def test_a_missing_codec_comes_with_its_exact_pip_line(monkeypatch):
    """Decoders are taken away for real: the packages behind them cannot be imported in the child."""
    code = (
        "import json, sys\n"
        "for name in ('libjpeg', 'openjpeg', 'jpeg_ls', 'gdcm', 'PIL', 'pylibjpeg'):\n"
        "    sys.modules[name] = None\n"
        "from stackloft.cli.doctor.codecs import decodable\n"
        "print(json.dumps(decodable(None)))\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    said = json.loads(run.stdout)
    monkeypatch.setattr(codecs, "ask_child", lambda _: Answer(said))
    fixes = {row.name: row.fix for row in codecs.transfer_syntaxes() if row.state == "broken"}
    assert fixes["1.2.840.10008.1.2.4.80"] == "python -m pip install pyjpegls"
    assert fixes["1.2.840.10008.1.2.4.90"] == "python -m pip install pylibjpeg pylibjpeg-openjpeg"
    assert fixes["1.2.840.10008.1.2.4.70"] == "python -m pip install pylibjpeg pylibjpeg-libjpeg"


def test_a_missing_system_library_comes_with_its_package(monkeypatch):
    said = "ImportError: libOpenGL.so.0: cannot open shared object file: No such file or directory"
    monkeypatch.setattr(libraries, "ask_child", lambda _, module: Answer([said, "Traceback"]))
    row = libraries.packages()[0]
    assert (row.name, row.state) == ("pymeshlab", "broken")
    assert row.detail == "the system library libOpenGL.so.0 is missing"
    assert row.fix == "apt-get install libgl1 libopengl0"


def test_heavy_packages_are_imported_in_children_alone():
    assert {row.state for row in libraries.packages()} <= {"ok", "broken"}
    assert "pymeshlab" not in sys.modules


def test_whether_pictures_can_be_drawn_is_an_answer_and_no_crash():
    row = rendering.rendering()
    assert row.state in {"ok", "warning"}
    if row.state == "warning":
        assert row.fix


def test_kernels_that_are_used_are_fine(monkeypatch):
    monkeypatch.setattr(kernels, "kernels", object)
    assert kernels.compiled_kernels().state == "ok"


@pytest.mark.parametrize(
    ("environment", "fix"),
    [
        ({"CC": sys.executable}, "python -m stackloft.compiled.building"),
        ({"CC": "/nowhere/cc"}, "apt-get install gcc libc6-dev, then: python -m stackloft.compiled.building"),
        ({"STACKLOFT_COMPILED": "0"}, "unset STACKLOFT_COMPILED"),
    ],
)
def test_kernels_that_are_not_used_are_a_warning_with_the_way_to_get_them(environment, fix, monkeypatch):
    monkeypatch.delenv("STACKLOFT_COMPILED", raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(kernels, "kernels", lambda: None)
    monkeypatch.setattr(kernels, "why_not", lambda: "it was not compiled")
    row = kernels.compiled_kernels()
    assert (row.state, row.fix) == ("warning", fix)
    assert "it was not compiled" in row.detail
