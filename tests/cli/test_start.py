"""The command answers at once: nothing heavy is imported for help."""

import resource
import subprocess
import sys
from importlib.metadata import version

import pytest

HEAVY = ("numpy", "scipy", "cv2", "PIL", "vtk", "vtkmodules", "matplotlib", "SimpleITK", "skimage")
STUDIES = ["regress", "convergence", "accuracy"]
COMMANDS = ["measure", "info", "phantom", "plugins list", "plugins show", "plugins doctor", *STUDIES]


@pytest.mark.parametrize(
    ("arguments", "heavy"),
    [(["--help"], (*HEAVY, "pydantic")), *(([*name.split(), "--help"], HEAVY) for name in COMMANDS)],
    ids=["stackloft", *COMMANDS],
)
def test_help_imports_nothing_heavy(arguments, heavy):
    """Typer itself takes pydantic to a command's own help, so that one is excused there."""
    code = (
        "import sys; from stackloft.cli import main\n"
        "try:\n    main()\n"
        "except SystemExit as end:\n    assert not end.code, end.code\n"
        f"print('heavy:', [name for name in {heavy!r} if name in sys.modules])\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True, timeout=60
    )
    assert "Usage: " in run.stdout
    assert run.stdout.endswith("heavy: []\n")


def test_help_takes_less_than_three_tenths_of_a_second(stackloft):
    """Processor time, for the clock on the wall also counts what else the machine does."""
    seconds = []
    for _ in range(5):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        assert stackloft("--help").returncode == 0
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds.append(after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
    assert min(seconds) < 0.3, seconds


def test_the_version_is_the_installed_one(stackloft):
    assert stackloft("--version").stdout.strip() == version("stackloft")


def test_importing_the_command_imports_no_typer():
    code = "import sys, stackloft.cli; print('typer' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "False\n"


def test_wrong_usage_leaves_with_two_and_without_traceback(stackloft):
    for arguments in (["measure"], ["measure", "x", "--no-such-flag"], ["no-such-command"]):
        run = stackloft(*arguments)
        assert run.returncode == 2, arguments
        assert run.stdout == ""
        assert "Traceback" not in run.stderr
