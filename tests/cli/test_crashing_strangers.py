"""A stranger's plug-in that raises, leaves or crashes the process: it is named, nothing else suffers."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from stackloft.testing.conformance.throwaway import write_distribution

SOURCE = """
import ctypes, os, sys
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar
import numpy as np
from stackloft.contracts.recipe import Recipe
from stackloft.model.contour_stack import ContourStack
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.measurement import Integral
from stackloft.model.segmentation import SectionField, Segmentation
from stackloft.model.slice_stack import SectionKind, SliceStack

def deep(n=0): return deep(n + 1)
def deepest():
    sys.setrecursionlimit(10**9)
    ctypes.pythonapi.Py_SetRecursionLimit(10**9) if hasattr(ctypes.pythonapi, 'Py_SetRecursionLimit') else 0
    class Odd(dict):
        def __missing__(self, key): return self[key]
    return Odd()[1]

MANNERS = {
    "abort": os.abort,
    "segfault": lambda: ctypes.string_at(0),
    "exit": lambda: sys.exit(3),
    "_exit": lambda: os._exit(0),
    "raise": lambda: 1 / 0,
    "recursion": deep,
    "stack": deepest,
}
WHERE, _, MANNER = os.environ.get("ACME", "").partition(":")

def here(place):
    if place == WHERE:
        MANNERS[MANNER]()

here("import")

class Plugin:
    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (ContourStack,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)
    def __post_init__(self): here("options")

@dataclass(frozen=True)
class Reader(Plugin):
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (SliceStack,)
    def probe(self, path):
        here("probe")
        return 0.9 if path.suffix == ".acme" else 0.0
    def read(self, path):
        here("read")
        def decode(k):
            here("decode")
            y, x = np.mgrid[:64, :64]
            ball = (x - 32) ** 2 + (y - 32) ** 2 < (12 + 3 * min(k, 6 - k)) ** 2
            return np.where(ball, 200, 20).astype(np.uint8)
        return SliceStack(decode, tuple("abcdefg"), (64, 64), 5.0 * np.arange(7),
                          np.full((7, 2), 0.5), SectionKind.FACE)

@dataclass(frozen=True)
class Segmenter(Plugin):
    accepts: ClassVar[tuple[type, ...]] = (SliceStack,)
    produces: ClassVar[tuple[type, ...]] = (Segmentation,)
    def segment(self, stack):
        here("segment")
        def field_of(k, picture):
            here("field")
            return SectionField(picture.astype(float), 110.0)
        return Segmentation(stack, field_of)

@dataclass(frozen=True)
class Integrator(Plugin):
    def integrate(self, product):
        here("integrate")
        return Integral(5.0, 6.0)

@dataclass(frozen=True)
class Writer(Plugin):
    accepts: ClassVar[tuple[type, ...]] = (LoftedSolid,)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".acme",)
    def write(self, product, stream):
        stream.write(b"half")
        stream.flush()
        here("write")

acme = Recipe(("integrator.acme",), "acme")
"""
GROUPS = {
    "stackloft.readers": {"acme": "acme_crash:Reader"},
    "stackloft.segmenters": {"acme-seg": "acme_crash:Segmenter"},
    "stackloft.integrators": {"acme": "acme_crash:Integrator"},
    "stackloft.writers": {"acme": "acme_crash:Writer"},
    "stackloft.recipes": {"acme": "acme_crash:acme"},
}


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    write_distribution(folder, "acme-crash", GROUPS, {"acme_crash": SOURCE}, "1.3")
    (folder / "body.acme").touch()
    return folder


@pytest.fixture
def run(stackloft, site):
    def command(fault, *arguments, **how):
        environment = {**os.environ, "PYTHONPATH": str(site), "ACME": fault}
        return stackloft(*arguments, env=environment, **how)

    return command


ENDS = {
    "abort": r"crashed the process (SIGABRT)",
    "segfault": r"crashed the process (SIGSEGV)",
    "_exit": "left the process with status 0",
    "raise": "ZeroDivisionError: division by zero",
    "exit": "SystemExit: 3",
    "recursion": "RecursionError",
    "stack": "crashed the process (SIGSEGV)",
}
PLACES = {
    "read": ("reader.acme", []),
    "decode": ("reader.acme", []),
    "segment": ("segmenter.acme-seg", ["--segmenter", "acme-seg"]),
    "field": ("segmenter.acme-seg", ["--segmenter", "acme-seg"]),
    "integrate": ("integrator.acme", ["--method", "acme"]),
}


FEW = [("read", "segfault"), ("decode", "abort"), ("field", "_exit"), ("integrate", "stack")]


@pytest.mark.parametrize(("place", "manner"), FEW)
def test_the_one_that_failed_is_named(run, site, place, manner):
    named(run, site, place, manner)


@pytest.mark.prove
def test_every_manner_of_failing_at_every_place_is_named(run, site, proof):
    rows = [(place, *(named(run, site, place, manner) for manner in ENDS)) for place in PLACES]
    claim = "A stranger's plug-in that fails during `measure` is named with its distribution, status 1"
    proof("crashing-strangers", claim, ("where", *ENDS), rows)


def named(run, site, place, manner):
    key, arguments = PLACES[place]
    told = run(f"{place}:{manner}", "measure", site / "body.acme", "--segmenter", "histogram", *arguments)
    assert told.returncode == 1
    assert told.stdout == ""
    assert "Traceback" not in told.stderr
    line = told.stderr.splitlines()[-1]
    assert line.startswith(f"stackloft: plug-in {key} of acme-crash 1.3 ")
    assert ENDS[manner] in line
    return "named"


@pytest.mark.prove
def test_without_a_fault_the_strangers_measure(run, site):
    told = run("", "measure", site / "body.acme", "--segmenter", "acme-seg", "--json")
    assert told.returncode == 0, told.stderr
    assert json.loads(told.stdout)["objects"][0]["volume"]["value"] > 0


COMMANDS = {"info": [], "convergence": ["--method", "cavalieri"], "measure": ["--segmenter", "histogram"]}


@pytest.mark.parametrize(
    ("fault", "command"),
    [
        ("import:abort", "measure"),
        pytest.param("import:abort", "info", marks=pytest.mark.prove),
        pytest.param("import:abort", "convergence", marks=pytest.mark.prove),
        pytest.param("probe:segfault", "measure", marks=pytest.mark.prove),
        pytest.param("import:_exit", "info", marks=pytest.mark.prove),
        pytest.param("probe:exit", "info", marks=pytest.mark.prove),
    ],
)
def test_nobody_asked_for_it_so_the_command_goes_on_without_it(run, stackloft, ball_folder, command, fault):
    arguments = [command, ball_folder, *COMMANDS[command]]
    told, alone = run(fault, *arguments), stackloft(*arguments)
    assert (told.returncode, alone.returncode) == (0, 0), told.stderr
    assert told.stdout == alone.stdout
    if "exit" not in fault.partition(":")[2]:
        assert "of acme-crash 1.3 crashed the process" in told.stderr
        assert "it is left out" in told.stderr


@pytest.mark.prove
def test_under_all_methods_the_others_are_measured(run, site, ball_folder):
    arguments = ("measure", ball_folder, "--segmenter", "histogram", "--method", "all", "--json")
    told, alone = run("integrate:abort", *arguments), run("", *arguments)
    assert told.returncode == 0, told.stderr
    rows, others = (json.loads(x.stdout)["objects"][0]["methods"] for x in (told, alone))
    reason = rows.pop("acme")["error"]
    assert "integrator.acme of acme-crash 1.3" in reason
    assert "integrate crashed the process (SIGABRT)" in reason
    for name, row in rows.items():
        assert row["volume"] == others[name]["volume"], name


@pytest.mark.prove
def test_one_that_was_asked_for_and_cannot_be_imported_is_named(run, site):
    told = run("import:segfault", "measure", site / "body.acme", "--reader", "acme")
    assert told.returncode == 1
    assert "plug-in reader.acme of acme-crash 1.3 is quarantined" in told.stderr.splitlines()[-1]
    assert "import crashed the process (SIGSEGV)" in told.stderr.splitlines()[-1]


@pytest.mark.prove
def test_no_other_reader_takes_the_place_of_one_that_crashed(run, ball_folder, tmp_path):
    """The folder is claimed by the stranger (0.9) before the photographs' reader could have it."""
    folder = tmp_path / "slices.acme"
    folder.mkdir()
    for path in ball_folder.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    told = run("read:abort", "measure", folder, "--segmenter", "histogram")
    assert (told.returncode, told.stdout) == (1, "")
    assert "plug-in reader.acme of acme-crash 1.3 crashed the process (SIGABRT) in read" in told.stderr


@pytest.mark.parametrize("manner", ["abort", pytest.param("raise", marks=pytest.mark.prove)])
def test_a_writer_that_crashes_leaves_nothing_half_written(run, ball_folder, tmp_path, manner):
    out = tmp_path / "out"
    arguments = ("--segmenter", "histogram", "--out", out, "--write", "stl,acme")
    told = run(f"write:{manner}", "measure", ball_folder, *arguments)
    assert told.returncode == 1
    assert "writer.acme of acme-crash 1.3" in told.stderr.splitlines()[-1]
    names = {path.name for path in out.iterdir()}
    assert "solid.acme" not in names
    assert not [name for name in names if name.startswith(".")]
    assert {"measurement.json", "solid.stl"} <= names


OTHERS = [["plugins", "list"], ["plugins", "check", "writer.stl"], ["plugins", "doctor", "writer.stl"]]


@pytest.mark.parametrize(
    "arguments",
    [
        ["plugins", "show", "cavalieri"],
        *(pytest.param(words, marks=pytest.mark.prove) for words in OTHERS),
    ],
)
def test_every_other_command_still_works(run, arguments):
    told = run("import:abort", *arguments)
    assert told.returncode == 0, told.stderr
    assert "Traceback" not in told.stderr


def test_an_interrupted_child_is_an_interrupted_command(site):
    """Ctrl-C in a terminal reaches the whole group; the command leaves as it does without strangers."""
    slow = (
        "from stackloft.cli import main, measure\nimport time\n"
        "measure.run = lambda *_: time.sleep(60)\nmain()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", slow, "measure", str(site / "body.acme")],
        env={**os.environ, "PYTHONPATH": str(site)},
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    while not _asleep(process.pid):
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert told == "stackloft: interrupted; nothing half-written is left behind\n"


def _asleep(parent):
    """Whether the child is there and has nothing left to do but to wait."""
    pids = Path(f"/proc/{parent}/task/{parent}/children").read_text(encoding="ascii").split()
    return bool(pids) and Path(f"/proc/{pids[0]}/stat").read_text(encoding="ascii").split()[2] == "S"


def test_runs_of_the_built_in_plugins_start_no_child(ball_folder):
    code = "import os\nos.fork = None\nfrom stackloft.cli import main\nmain()"
    told = subprocess.run(
        [sys.executable, "-c", code, "measure", str(ball_folder), "--quiet"],
        capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert told.returncode == 0, told.stderr
