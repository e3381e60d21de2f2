"""Scans are measured slice by slice: what is in memory does not grow with them."""

import json
import shutil
import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from stackloft.model.slice_stack import SectionKind, SliceStack
from stackloft.pipeline.api import measure

METHODS = "loft,cavalieri,partial-volume"
CHILD = """
import json, sys, time
from pathlib import Path
import stackloft

def peak():
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return float(status.partition("VmHWM:")[2].split()[0]) / 1024

said = dict(method=sys.argv[3], pixel_size="0.1mm", thickness="0.1mm")
stackloft.measure(Path(sys.argv[1]), **said)
before, start = peak(), time.perf_counter()
body = stackloft.measure(Path(sys.argv[2]), **said).objects[0]
figures = {name: row.volume.value for name, row in body.methods.items()}
print(json.dumps({"peak": peak() - before, "seconds": time.perf_counter() - start, "figures": figures}))
"""


def ball(k: int, count: int, side: int, radius: float) -> np.ndarray:
    """Return slice k of `count` through a ball, by how much of every pixel it fills, 0 … 1000."""
    y, x = np.mgrid[:side, :side] - 0.5 * (side - 1)
    height = (2 * (k + 0.5) / count - 1) * 1.02  # the outermost slices lie beyond the ball
    edge = radius * np.sqrt(max(0.0, 1 - height**2))
    covered = np.clip(edge - np.hypot(x, y) + 0.5, 0, 1) if edge else np.zeros((side, side))
    return (1000 * covered).astype(np.uint16)


def peak_of(slices: int) -> float:
    """Return the largest memory while a stack of so many slices of 0.5 MB is measured, MB."""
    picture = np.zeros((512, 512), np.uint16)

    def decode(k: int) -> np.ndarray:
        whole = picture.copy()
        whole[226:286, 226:286] = ball(k, slices, 60, 20.0)
        return whole

    names = tuple(map(str, range(slices)))
    spacing = np.full((slices, 2), 0.1)
    stack = SliceStack(decode, names, (512, 512), 0.1 * np.arange(slices), spacing, SectionKind.SLAB)
    tracemalloc.start()
    try:
        measure(stack, method=METHODS)
        return tracemalloc.get_traced_memory()[1] / 1e6
    finally:
        tracemalloc.stop()


def test_four_times_as_many_slices_take_hardly_more_memory():
    peak_of(12)  # whatever is imported on the way
    few, many = peak_of(40), peak_of(160)
    assert many - few < 0.15 * 120 * 0.524  # MB: what 120 more slices would take


def write_array(path: Path, count: int, side: int, radius: float) -> float:
    """Write a ball of that many slices into an array of `count` × `side`² on the disk; return its volume."""
    room = 2 * int(radius) + 20
    low = (side - room) // 2
    array = np.lib.format.open_memmap(path, mode="w+", dtype=np.uint16, shape=(count, side, side))
    for k in range(count):
        array[k, low : low + room, low : low + room] = ball(k, count, room, radius)
        if k % 64 == 63:
            array.flush()
    del array
    return 2 / 3 * 0.1**3 * np.pi * radius**2 * count / 1.02


@pytest.mark.prove
def test_a_stack_of_2048_slices_of_2048_squared_takes_less_than_a_gigabyte(tmp_path, proof):
    """8.6 thousand million voxels, 17 GB: every slice is read and looked at."""
    if shutil.disk_usage(tmp_path).free < 30e9:
        pytest.skip("needs 30 GB of disk")
    small, large = tmp_path / "small.npy", tmp_path / "large.npy"
    write_array(small, 24, 64, 20.0)
    truth = write_array(large, 2048, 2048, 200.0)
    done = subprocess.run(
        [sys.executable, "-c", CHILD, str(small), str(large), METHODS],
        capture_output=True,
        text=True,
        check=True,
    )
    large.unlink()
    found = json.loads(done.stdout)
    rows = [
        (name, f"{volume:.0f}", f"{100 * (volume / truth - 1):+.3f}")
        for name, volume in found["figures"].items()
    ]
    rows.append(("peak above imports, MB", f"{found['peak']:.0f}", ""))
    rows.append(("seconds, on a machine at work", f"{found['seconds']:.0f}", ""))
    proof(
        "scan-memory",
        "2048 slices of 2048² 16-bit pixels (17 GB): a ball of 400 pixels across, "
        "loft, cavalieri and partial-volume in one run",
        ("what", "mm³", "% of the truth"),
        rows,
    )
    assert found["peak"] < 1000.0
    assert all(abs(volume / truth - 1) < 0.003 for volume in found["figures"].values())
