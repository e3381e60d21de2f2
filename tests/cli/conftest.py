"""A small stack of photographs, and the command line run in a process of its own."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

COMMAND = [str(Path(sys.executable).with_name("stackloft"))]


@pytest.fixture(scope="session")
def stackloft():
    """Return a function that runs ``stackloft`` with arguments and returns the finished process."""

    def run(*arguments, **options):
        options = {"capture_output": True, "text": True, "timeout": 120, **options}
        return subprocess.run([*COMMAND, *map(str, arguments)], check=False, **options)

    return run


@pytest.fixture(scope="session")
def ball_folder(tmp_path_factory):
    """Return a folder of nine photographs of a ball of radius 20 mm, cut at mid-thickness, 0.5 mm pixels."""
    folder = tmp_path_factory.mktemp("stacks") / "ball"
    folder.mkdir()
    rows, columns = np.mgrid[:110, :130] * 0.5
    pitch = 40 / 9
    for number in range(9):
        z = -20 + pitch * (number + 0.5)
        distance = np.hypot(columns - 33.1, rows - 26.7) - np.sqrt(400 - z * z)
        grey = 230 - 170 * np.clip(0.5 - distance / 0.5, 0, 1)
        Image.fromarray(grey.round().astype(np.uint8)).save(folder / f"cut_{number + 1}.png")
    (folder / "stack.toml").write_text(f'pixel_size = "0.5mm"\nthickness = "{pitch}mm"\n')
    return folder
