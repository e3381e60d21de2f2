"""The kernels' own threads: shared by the program's threads, and not missed in a fork of it."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from stackloft.compiled.library import kernels
from stackloft.compiled.smooth_curve import smooth_closed

pytestmark = pytest.mark.skipif(kernels() is None, reason="no compiled kernels here")

FORKED = """
import os, sys
import numpy as np
from stackloft.compiled.smooth_curve import smooth_closed
t = np.linspace(0.0, 6.28, 400, endpoint=False)
loops = [k * np.column_stack([np.cos(t), np.sin(t)]) for k in range(20, 40)]
before = smooth_closed(loops, 1.0, 0.25, 8)
child = os.fork()
if not child:
    same = all(np.array_equal(a, b) for a, b in zip(before, smooth_closed(loops, 1.0, 0.25, 8)))
    os._exit(0 if same else 1)
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


def test_loops_come_out_alike_whoever_asks_at_the_same_time():
    t = np.linspace(0.0, 2.0 * np.pi, 500, endpoint=False)
    loops = [k * np.column_stack([np.cos(t), np.sin(t)]) for k in range(20, 60)]
    alone = [smooth_closed([loop], 1.0, 0.25, 8)[0] for loop in loops]
    with ThreadPoolExecutor(6) as pool:
        for together in pool.map(lambda _: smooth_closed(loops, 1.0, 0.25, 8), range(60)):
            assert all(np.array_equal(own, other) for own, other in zip(alone, together, strict=True))


@pytest.mark.skipif(sys.platform == "win32", reason="no fork here")
def test_a_fork_works_without_the_threads_of_its_parent():
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", FORKED],
        timeout=120,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
