"""A file is there whole, or as it was before; never half, and no litter."""

import errno
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

from stackloft.model.errors import OutputError
from stackloft.report.whole_file import whole_file, writable_folder


def names(folder):
    return sorted(item.name for item in folder.iterdir())


def test_the_bytes_arrive_and_replace_the_old_ones(tmp_path):
    path = tmp_path / "result.json"
    path.write_text("old")
    with whole_file(path) as stream:
        stream.write(b"new")
        assert path.read_text() == "old", "replaced in one step, at the end"
    assert path.read_text() == "new"
    assert names(tmp_path) == ["result.json"]


@pytest.mark.parametrize("failure", [KeyboardInterrupt, ValueError, SystemExit])
def test_whatever_interrupts_leaves_the_old_file_and_no_litter(tmp_path, failure):
    path = tmp_path / "result.json"
    path.write_text("old")

    def write():
        with whole_file(path) as stream:
            stream.write(b"half")
            raise failure

    with pytest.raises(failure):
        write()
    assert path.read_text() == "old"
    assert names(tmp_path) == ["result.json"]


@pytest.mark.parametrize(
    ("number", "words"),
    [(errno.ENOSPC, "no space left.*free some disk space"), (errno.EROFS, "read-only.*can be written")],
)
def test_what_the_system_refuses_is_one_line_with_a_fix(tmp_path, monkeypatch, number, words):
    def refuse(handle):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(os, "fsync", refuse)
    with pytest.raises(OutputError, match=f"(?i){words}") as caught, whole_file(tmp_path / "a.csv") as stream:
        stream.write(b"x")
    assert "\n" not in str(caught.value)
    assert names(tmp_path) == []


def test_a_disk_that_really_takes_no_more(tmp_path):
    """A limit on the size of files, set in a child process, refuses bytes as a full disk does."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))

    code = (
        "import sys; from pathlib import Path\n"
        "from stackloft.model.errors import OutputError\n"
        "from stackloft.report.whole_file import whole_file\n"
        "try:\n"
        "    with whole_file(Path(sys.argv[1])) as stream: stream.write(bytes(50_000))\n"
        "except OutputError as error: print(error)\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "solid.stl")],
        preexec_fn=limit,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "solid.stl: cannot be written: file too large; fix: free some disk space" in run.stdout
    assert names(tmp_path) == []


def test_a_folder_is_made_with_its_parents_and_left_empty(tmp_path):
    folder = writable_folder(tmp_path / "a" / "b")
    assert folder.is_dir()
    assert names(folder) == []


def test_a_folder_that_is_a_file_is_refused(tmp_path):
    path = tmp_path / "out"
    path.write_text("")
    with pytest.raises(OutputError, match="is a file, not a folder"):
        writable_folder(path)
    with pytest.raises(OutputError, match="is a file, not a folder"):
        writable_folder(path / "below")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_read_only_folder_is_refused_before_anything_is_measured(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(OutputError, match=r"permission denied.*you may write"):
        writable_folder(tmp_path)


def test_a_folder_of_the_kernel_is_refused_to_root_too():
    with pytest.raises(OutputError, match="/proc/self/out"):
        writable_folder(Path("/proc/self/out"))
