"""Completion in bash, zsh and fish: by the protocol of each, and in the shells themselves where they are."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from typer.main import get_command

from stackloft.cli.app import app
from stackloft.cli.completion.answer import candidates
from stackloft.cli.completion.line import split_line
from stackloft.testing.conformance.throwaway import write_distribution

BIN = str(Path(sys.executable).parent)
SHELLS = ("bash", "zsh", "fish")


@pytest.fixture
def ask(stackloft):
    """Return a function that asks as a shell does, and gives the kind of answer and the words."""

    def asked(line, shell="fish", **more):
        environment = {**os.environ, "_STACKLOFT_COMPLETE": shell, "_STACKLOFT_LINE": line, **more}
        environment.setdefault("_STACKLOFT_BREAKS", " \t\n\"'><=;|&(:")
        told = stackloft(env=environment)
        assert (told.returncode, told.stderr) == (0, "")
        kind, *rows = told.stdout.splitlines()
        return kind, [row.split("\t")[0] for row in rows], rows

    return asked


CASES = {
    "stackloft me": ["measure", "mesh"],
    "stackloft measure x --meth": ["--method"],
    "stackloft measure x --method carr": [],
    "stackloft measure x --method fru": ["frustum"],
    "stackloft measure x --method=fru": ["--method=frustum"],
    "stackloft measure x --method frustum,cav": ["frustum,cavalieri"],
    "stackloft measure x --reader nu": ["numpy"],
    "stackloft measure x --segmenter co": ["colour"],
    "stackloft measure x --write stl,pl": ["stl,ply"],
    "stackloft measure --set segmenter.scop": ["segmenter.scope="],
    "stackloft measure --set cavalieri.rule=t": ["cavalieri.rule=trapezoid"],
    "stackloft measure --set integrator.cavalieri.rule=r": ["integrator.cavalieri.rule=rectangle"],
    "stackloft measure x --units i": ["in"],
    "stackloft plugins sho": ["show"],
    "stackloft plugins show hist": ["histogram"],
    "stackloft plugins check integrator.cav": ["integrator.cavalieri"],
    "stackloft plugins new recon": ["reconstructor"],
    "stackloft phantom potat": ["potato"],
    "stackloft convergence x --tol": ["--tolerance"],
    "stackloft measure 'two words' --object l": ["largest"],
    "stackloft measure --quiet --qui": [],
    "stackloft completion f": ["fish"],
}


@pytest.mark.parametrize("line", CASES)
def test_what_may_come_next(line):
    found = candidates(get_command(app), split_line(line))
    assert [item.word for item in found] == CASES[line]


@pytest.mark.parametrize("shell", SHELLS)
def test_every_shell_is_told_the_same(ask, shell):
    kind, words, rows = ask("stackloft plugins show cav", shell)
    assert (kind, words) == ("words", ["cavalieri"])
    assert rows == ["cavalieri\tintegrator and recipe"]


def test_paths_are_left_to_the_shell(ask):
    for line in ("stackloft measure ./", "stackloft measure x --recipe ", "stackloft info "):
        assert ask(line)[0] == "files", line


def test_bash_is_given_what_it_takes_for_the_word(ask):
    """Bash breaks words at = and at colons."""
    assert ask("stackloft measure --set cavalieri.rule=t", "bash")[1] == ["trapezoid"]
    assert ask("stackloft measure x --ends round,poi", "bash")[1] == ["round,point:"]
    assert ask("stackloft measure --set cavalieri.rule=t", "bash", _STACKLOFT_BREAKS=" ")[1] == [
        "cavalieri.rule=trapezoid"
    ]


def test_a_word_that_is_not_finished_gets_no_space(ask):
    assert ask("stackloft measure --set cavalieri.ru")[2][0].endswith("\topen")
    assert not ask("stackloft measure --method frus")[2][0].endswith("\topen")


def test_strangers_are_completed_and_not_imported(ask, tmp_path):
    source = """
    import os
    os.abort()
    class Reader:
        detector_gap: float = option(0.0, "between the tiles")
    """
    site = write_distribution(
        tmp_path, "acme-xct", {"stackloft.readers": {"acme-xct": "acme_x:Reader"}}, {"acme_x": source}
    )
    path = {"PYTHONPATH": str(site)}
    assert ask("stackloft measure x --reader ac", **path)[1] == ["acme-xct"]
    assert ask("stackloft measure x --set acme-xct.", **path)[1] == ["acme-xct.detector_gap="]


def test_no_plugin_and_nothing_heavy_is_imported():
    code = (
        "import sys; from stackloft.cli import main; main()\n"
        "heavy = ['numpy', 'scipy', 'cv2', 'PIL', 'matplotlib', 'pydantic', 'stackloft_plugins', 'rich']\n"
        "print([name for name in heavy if name in sys.modules], file=sys.stderr)"
    )
    line = {"_STACKLOFT_COMPLETE": "fish", "_STACKLOFT_LINE": "stackloft measure --set segmenter."}
    told = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, **line}, capture_output=True, text=True, check=True
    )
    assert told.stderr == "[]\n"
    assert "segmenter.scope=" in told.stdout


ASK_BASH = """
eval "$(stackloft completion bash)"
compopt() {{ echo "compopt $*"; }}
COMP_LINE={line!r}; COMP_POINT=${{#COMP_LINE}}
_stackloft_complete stackloft
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
ASK_FISH = """
stackloft completion fish | source
complete --do-complete {line!r}
"""
ASK_ZSH = """
zmodload zsh/zpty
zpty -b shell zsh -f -i
zpty -w shell 'PS1="ready> "; autoload -Uz compinit; compinit -u -D; eval "$(stackloft completion zsh)"; PS2='
all=
sees() {{
    repeat 200; do
        while zpty -r -t shell told; do all+=${{told//$'\a'/}}; done
        [[ $all == *$1* ]] && return
        sleep 0.1
    done
}}
sees 'ready> '
zpty -w -n shell {line!r}$'\t'
sees {whole!r}
print -r -- $all
zpty -d shell
"""


def in_shell(shell, script):
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    environment = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}", "TERM": "dumb"}
    run = subprocess.run(
        [shell, "-c", script], capture_output=True, text=True, check=False, env=environment, timeout=60
    )
    return run.stdout


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("stackloft mea", ["measure"]),
        ("stackloft measure --set cavalieri.ru", ["compopt -o nospace", "cavalieri.rule="]),
        ("stackloft measure --set cavalieri.rule=tr", ["trapezoid"]),
        ("stackloft measure x", ["compopt -o default", ""]),
    ],
)
def test_in_bash(line, words):
    assert in_shell("bash", ASK_BASH.format(line=line)).splitlines() == words


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("stackloft mea", ["measure"]),
        ("stackloft measure --set cavalieri.ru", ["cavalieri.rule="]),
        ("stackloft measure --set cavalieri.rule=tr", ["cavalieri.rule=trapezoid"]),
    ],
)
def test_in_fish(line, words):
    told = in_shell("fish", ASK_FISH.format(line=line))
    assert [row.split("\t")[0] for row in told.splitlines()] == words


@pytest.mark.parametrize(
    ("line", "whole"),
    [
        ("stackloft mea", "stackloft measure"),
        ("stackloft measure --set cavalieri.rule=tr", "stackloft measure --set cavalieri.rule=trapezoid"),
    ],
)
def test_in_zsh(line, whole):
    assert f"ready> \x1b[?2004h{whole}" in in_shell("zsh", ASK_ZSH.format(line=line, whole=whole))


@pytest.mark.parametrize("shell", SHELLS)
def test_the_script_says_where_it_belongs(stackloft, shell):
    told = stackloft("completion", shell)
    assert told.returncode == 0
    assert f"stackloft completion {shell}" in told.stdout
    if shutil.which(shell):
        assert subprocess.run([shell, "-n"], input=told.stdout, text=True, check=False).returncode == 0


def test_another_shell_is_wrong_usage(stackloft):
    told = stackloft("completion", "fishy")
    assert (told.returncode, told.stdout) == (2, "")
    assert "did you mean fish?" in told.stderr
