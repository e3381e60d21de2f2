"""An environment of its own for authors' packages: the tools of this one, and room to install into."""

import os
import subprocess
import sys
import sysconfig
import venv

import pytest

SCRIPTS = {
    "pip": f'exec {sys.executable} -m pip --python "$HERE/python" "$@"',
    "pytest": 'exec "$HERE/python" -m pytest "$@"',
    "stackloft": 'exec "$HERE/python" -m stackloft.cli "$@"',
}


class Lab:
    """A virtual environment in which `sh` runs commands; no network is asked."""

    def __init__(self, folder):
        self.folder = folder
        venv.create(folder / "venv", symlinks=True)
        self.bin = folder / "venv" / "bin"
        site = next((folder / "venv" / "lib").glob("python*/site-packages"))
        outer = sysconfig.get_paths()["purelib"]
        (site / "tools.pth").write_text(f"import site; site.addsitedir({outer!r})\n")
        for name, line in SCRIPTS.items():
            script = self.bin / name
            script.write_text(f'#!/bin/sh\nHERE="{self.bin}"\n{line}\n')
            script.chmod(0o755)

    def sh(self, command, cwd, status=0):
        """Run a command line and return what it printed."""
        environment = {**os.environ, "PATH": f"{self.bin}:{os.environ['PATH']}", "PIP_NO_INDEX": "1"}
        environment |= {"PIP_DISABLE_PIP_VERSION_CHECK": "1", "OMP_NUM_THREADS": "1"}
        environment.pop("PYTEST_ADDOPTS", None)
        run = subprocess.run(
            command,
            check=False,
            shell=True,
            cwd=cwd,
            capture_output=True,
            text=True,
            env=environment,
            timeout=300,
        )
        assert run.returncode == status, f"{command}\n{run.stdout}\n{run.stderr}"
        return run.stdout if status == 0 else run.stdout + run.stderr


@pytest.fixture
def lab(tmp_path):
    """Return a fresh laboratory."""
    return Lab(tmp_path)
