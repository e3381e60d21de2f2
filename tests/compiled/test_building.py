"""Compiling the kernels: what comes out, what is told, and that builds at once do each other no harm."""

import ctypes
import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

from stackloft.compiled import building

needs_compiler = pytest.mark.usefixtures("c_compiler")


@needs_compiler
def test_a_library_is_made_of_the_sources_without_a_warning(tmp_path, capfd):
    target = tmp_path / building.LIBRARY.name
    assert building.build(target) == target
    assert capfd.readouterr().err == ""
    assert ctypes.CDLL(str(target)).stackloft_abi() == building.fingerprint()
    assert list(tmp_path.iterdir()) == [target]


def broken_compiler(tmp_path):
    script = tmp_path / "cc"
    script.write_text("#!/bin/sh\necho 'abi.c:7: the disk is full' >&2\nexit 4\n")
    script.chmod(0o755)
    return str(script)


def test_a_compiler_that_fails_is_told_of_with_its_message(tmp_path, monkeypatch, capfd):
    monkeypatch.setenv("CC", broken_compiler(tmp_path))
    folder = tmp_path / "target"
    folder.mkdir()
    assert building.build(folder / "kernels.so") is None
    said = capfd.readouterr().err.splitlines()
    assert said[0] == "abi.c:7: the disk is full"
    assert "failed with status 4; it works without compiled kernels, slower on scans" in said[1]
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("name", ["false", "true"])
def test_a_compiler_that_makes_nothing_leaves_the_library_that_was_there(name, tmp_path, monkeypatch, capfd):
    monkeypatch.setenv("CC", name)
    before = tmp_path / "kernels.so"
    before.write_bytes(b"old")
    assert building.build(before) is None
    assert capfd.readouterr().err.startswith(f"stackloft: {name} ")
    assert before.read_bytes() == b"old"


def test_a_machine_without_a_compiler_is_told_in_one_line(tmp_path, monkeypatch, capfd):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert building.build(tmp_path / "kernels.so") is None
    expected = "no C compiler was found (cc, gcc, clang); it works without compiled kernels, slower on scans"
    assert capfd.readouterr().err == f"stackloft: {expected}\n"


def test_the_compiler_that_cc_names_rules_out_every_other(monkeypatch):
    monkeypatch.setenv("CC", "/nowhere/cc")
    assert building.compiler() is None
    monkeypatch.setenv("CC", f"{sys.executable} -I")
    assert building.compiler() == [sys.executable, "-I"]


@needs_compiler
def test_builds_at_once_leave_one_whole_library_at_any_time(tmp_path):
    target = tmp_path / building.LIBRARY.name
    assert building.build(target) == target
    code = (
        "from pathlib import Path\nfrom stackloft.compiled import building\n"
        f"building.build(Path({str(target)!r}))"
    )
    running = [subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE) for _ in range(2)]
    check = f"import ctypes\nassert ctypes.CDLL({str(target)!r}).stackloft_abi() == {building.fingerprint()}"
    while any(process.poll() is None for process in running):
        subprocess.run([sys.executable, "-c", check], check=True)
    assert [process.communicate()[1] for process in running] == [b""] * 2
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("change", ["edited", "added", "renamed", "flags"])
def test_the_fingerprint_follows_every_source_and_flag(change, tmp_path, monkeypatch):
    source = tmp_path / "a.c"
    source.write_text("int a;\n")
    monkeypatch.setattr(building, "SOURCES", tmp_path)
    before = building.fingerprint()
    if change == "edited":
        source.write_text("int b;\n")
    elif change == "added":
        (tmp_path / "a.h").write_text("")
    elif change == "renamed":
        source.rename(tmp_path / "b.c")
    else:
        monkeypatch.setattr(building, "FLAGS", ("-O0",))
    assert building.fingerprint() != before
    assert 0 <= building.fingerprint() < 2**31


def test_the_build_hook_can_load_it_by_its_path_with_the_standard_library_alone():
    code = (
        "import importlib.util, sys\n"
        f"spec = importlib.util.spec_from_file_location('building', {building.__file__!r})\n"
        "module = importlib.util.module_from_spec(spec)\n"
        "spec.loader.exec_module(module)\n"
        "print(module.fingerprint(), {name.partition('.')[0] for name in sys.modules}"
        " - {'building', '__main__'} - sys.stdlib_module_names)\n"
    )
    run = subprocess.run([sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == f"{building.fingerprint()} set()\n"


def test_the_hook_s_tag_is_this_machine_s_and_no_manylinux():
    from packaging.tags import sys_tags  # noqa: PLC0415

    pytest.importorskip("hatchling")
    path = Path(__file__).parents[2] / "hatch_build.py"
    spec = importlib.util.spec_from_file_location("hatch_build", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    tag = f"py3-none-{module._platform()}"
    assert tag in set(map(str, sys_tags()))
    assert "manylinux" not in tag
