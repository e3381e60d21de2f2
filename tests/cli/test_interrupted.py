"""Ctrl-C, a full disk, a read-only folder: one line, the right status, no half-written file."""

import resource
import subprocess
import sys
from pathlib import Path

import pytest

STRIKE = """
import os, signal
from {module} import {owner}
own = {owner}.{name}
def strike(self, *arguments):
    {when}
        os.kill(os.getpid(), signal.SIGINT)
    return own(self, *arguments)
{owner}.{name} = strike
from stackloft.cli import main
main()
"""
MOMENTS = {
    "while decoding": {
        "module": "stackloft.report.thumbnails",
        "owner": "ThumbnailSink",
        "name": "add",
        "when": "if arguments[0] == 3:",
    },
    "while writing": {
        "module": "stackloft_plugins.writers.csv",
        "owner": "CsvWriter",
        "name": "write",
        "when": "if arguments[1].write(b'half'):",
    },
}


@pytest.mark.parametrize("moment", MOMENTS)
def test_control_c_is_one_line_and_status_130(ball_folder, tmp_path, moment):
    out = tmp_path / "out"
    run = subprocess.run(
        [
            sys.executable,
            "-c",
            STRIKE.format(**MOMENTS[moment]),
            "measure",
            str(ball_folder),
            "--out",
            str(out),
        ],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert run.returncode == 130, run.stderr
    assert run.stderr == "stackloft: interrupted; nothing half-written is left behind\n"
    whole = {"measurement.json", "recipe.toml"} if moment == "while writing" else set()
    assert {path.name for path in out.iterdir()} == whole


def test_control_c_before_the_command_is_even_there_is_one_line_too():
    code = (
        "import os, signal, sys\n"
        "class Strike:\n"
        "    def find_spec(self, name, path, target=None):\n"
        "        if name == 'typer': os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Strike())\n"
        "from stackloft.cli import main\n"
        "main()\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=60
    )
    assert (run.returncode, run.stderr) == (130, "stackloft: interrupted\n")


def test_a_full_disk_is_one_line_and_leaves_no_half_file(stackloft, ball_folder, tmp_path):
    """A limit on the size of files refuses bytes as a full disk does: the overview no longer fits."""
    out = tmp_path / "out"

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (9_000, 9_000))

    run = stackloft("measure", ball_folder, "--out", out, "--quiet", preexec_fn=limit)
    assert run.returncode == 1
    (line,) = run.stderr.splitlines()
    assert line.startswith(f"stackloft: {out / 'overview.png'}: cannot be written: ")
    assert "free some disk space" in line
    assert "overview.png" not in {path.name for path in out.iterdir()}
    assert not [path for path in out.iterdir() if path.name.startswith(".")]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_json_onto_a_full_disk_is_one_line(stackloft, ball_folder):
    with Path("/dev/full").open("w") as full:
        run = stackloft(
            "measure",
            ball_folder,
            "--json",
            "--quiet",
            capture_output=False,
            stdout=full,
            stderr=subprocess.PIPE,
        )
    assert run.returncode == 1
    assert run.stderr.splitlines()[-1] == "stackloft: no space left on device"
    assert "Exception ignored" not in run.stderr


def test_a_read_only_folder_is_refused_before_anything_is_measured(stackloft, tmp_path):
    """Even a source that does not exist is not looked for; /proc is read-only to root too."""
    run = stackloft("measure", tmp_path / "no-such-source", "--out", "/proc/self/out")
    assert run.returncode == 1
    assert run.stderr.startswith("stackloft: /proc/self/out: cannot be written: ")
    assert run.stderr.count("\n") == 1


def test_a_reader_that_went_away_is_no_traceback(ball_folder):
    command = f"{sys.executable} -m stackloft.cli measure {ball_folder} --json --quiet | head -c 10"
    run = subprocess.run(command, shell=True, capture_output=True, text=True, check=False, timeout=120)
    assert "Traceback" not in run.stderr
    assert "Exception ignored" not in run.stderr
