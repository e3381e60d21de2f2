"""What a worker does to itself ends in one clear error; the process that asked goes on."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from stackloft_plugins.worker import Limits, WorkerError, run_alone
from stackloft_plugins.worker.message import unpack

USUAL = Limits(60, 400)
DEEDS = """
import ctypes, os, signal, time
import numpy as np

def echo(arrays, **values):
    print("noise on stdout")
    return {**arrays, "sum": np.array(values["a"] + values["b"])}
def segfault(arrays): ctypes.string_at(0)
def abort(arrays): os.abort()
def leave(arrays): os._exit(7)
def silent(arrays): os._exit(0)
def hang(arrays, started=""):
    if started: open(started, "w").write(str(os.getpid()))
    while True: pass
def hoard(arrays):
    kept = []
    while True:
        kept.append(np.ones(2**20)); time.sleep(0.002)
def gulp(arrays): return {"a": np.ones(2**34)}
def raises(arrays): raise ValueError("the mesh is bad")
def litters(arrays):
    open("litter.txt", "w").write("here")
    return arrays
def killed(arrays): os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.fixture
def deed(tmp_path, monkeypatch):
    (tmp_path / "deeds.py").write_text(DEEDS, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))

    def call(name, limits=USUAL, arrays=None, **values):
        return run_alone(
            f"deeds:{name}", arrays or {}, values, limits, what="the deed", fixes={"time": "wait"}
        )

    return call


def test_arrays_and_values_go_there_and_back_bit_for_bit(deed):
    rng = np.random.default_rng(5)
    sent = {"points": rng.normal(size=(200_000, 3)), "faces": rng.integers(0, 9, (7, 3), dtype=np.int32)}
    back = deed("echo", arrays=sent, a=2, b=3)
    assert back["points"].tobytes() == sent["points"].tobytes()
    assert back["faces"].dtype == np.int32
    assert np.array_equal(back["faces"], sent["faces"])
    assert back["sum"] == 5


@pytest.mark.parametrize(
    ("name", "limits", "kind", "says"),
    [
        ("segfault", USUAL, "crash", "SIGSEGV"),
        ("abort", USUAL, "crash", "SIGABRT"),
        ("leave", USUAL, "crash", "status 7"),
        ("silent", USUAL, "crash", "status 0"),
        ("hang", Limits(1.0, 400), "time", "did not end within 1 s and was stopped; fix: wait"),
        ("hoard", Limits(60, 300), "memory", "needed more than 300 MB"),
        ("gulp", Limits(60, 300), "memory", "needed more than 300 MB"),
        ("killed", USUAL, "memory", "needed more than 400 MB"),
        ("raises", USUAL, "raised", "ValueError: the mesh is bad"),
    ],
)
def test_every_end_has_its_one_clear_error(deed, name, limits, kind, says):
    with pytest.raises(WorkerError, match=r"^the deed ") as caught:
        deed(name, limits)
    assert caught.value.kind == kind
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.skipif(sys.platform != "linux", reason="the system is asked for it in Linux's way")
def test_a_worker_does_not_outlive_its_parent(tmp_path):
    (tmp_path / "deeds.py").write_text(DEEDS, encoding="utf-8")
    started = tmp_path / "started"
    code = (
        "from stackloft_plugins.worker import Limits, run_alone;"
        f"run_alone('deeds:hang', {{}}, {{'started': {str(started)!r}}}, Limits(60, 400), what='x')"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *filter(None, sys.path)])}
    parent = subprocess.Popen([sys.executable, "-c", code], env=environment)
    while not (started.exists() and started.read_text(encoding="ascii")):
        time.sleep(0.02)
        assert parent.poll() is None
    worker = int(started.read_text(encoding="ascii"))
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    for _ in range(250):
        if not Path(f"/proc/{worker}").exists() or _state(worker) == "Z":
            return
        time.sleep(0.02)
    os.kill(worker, signal.SIGKILL)
    pytest.fail("the worker is still running")


def _state(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()[0]
    except OSError:
        return "Z"


def test_bytes_that_are_no_message_are_said_to_be_none():
    with pytest.raises(ValueError, match="not a message"):
        unpack(b"PK\x03\x04 cut off")


def test_what_a_library_drops_in_its_folder_is_gone(deed, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = sorted(tmp_path.iterdir())
    deed("litters", arrays={"a": np.zeros(1)})
    assert [path for path in sorted(tmp_path.iterdir()) if path.name != "__pycache__"] == before
