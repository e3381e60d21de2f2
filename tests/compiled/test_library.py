"""Loading the kernels: once, only the sources' own, and not where they are switched off."""

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from stackloft.compiled import building, library

needs_compiler = pytest.mark.usefixtures("c_compiler")


@pytest.fixture(scope="module")
def built(c_compiler, tmp_path_factory):
    """A library compiled now from the sources that there are."""
    return building.build(tmp_path_factory.mktemp("built") / building.LIBRARY.name)


@pytest.fixture
def of_its_own(monkeypatch):
    """Forget what this process loaded, before the test and after."""
    library._loaded_once.cache_clear()
    yield monkeypatch
    library._loaded_once.cache_clear()


@needs_compiler
def test_the_sources_own_library_is_loaded_once_by_many_threads(built, of_its_own):
    load, loads = library.load, []

    def slowly(path):  # long enough for every thread to ask meanwhile
        loads.append(path)
        time.sleep(0.1)
        return load(path)

    of_its_own.setattr(library, "LIBRARY", built)
    of_its_own.setattr(library, "load", slowly)
    of_its_own.delenv(building.SWITCH, raising=False)
    found = []
    threads = [threading.Thread(target=lambda: found.append(library.kernels())) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert loads == [built]
    assert found[0].stackloft_abi() == building.fingerprint()
    assert {id(one) for one in found} == {id(found[0])}
    assert library.why_not() == ""


@needs_compiler
def test_a_library_older_than_its_sources_is_refused(built, tmp_path, monkeypatch):
    newer = tmp_path / "source"
    newer.mkdir()
    for path in building.SOURCES.iterdir():
        (newer / path.name).write_text(path.read_text() + "/* edited */\n")
    monkeypatch.setattr(building, "SOURCES", newer)
    assert library.load(built) == (None, f"{built} was compiled from other sources than those beside it")


def test_what_is_no_library_is_refused(tmp_path):
    path = tmp_path / "kernels.so"
    path.write_bytes(b"\x7fELF half a file")
    found, reason = library.load(path)
    assert found is None
    assert reason.startswith(f"{path} does not load: ")


@needs_compiler
def test_somebody_else_s_library_is_refused(tmp_path, monkeypatch):
    sources = tmp_path / "source"
    sources.mkdir()
    (sources / "other.c").write_text("int other(void);\nint other(void) { return STACKLOFT_ABI; }\n")
    monkeypatch.setattr(building, "SOURCES", sources)
    path = building.build(tmp_path / building.LIBRARY.name)
    found, reason = library.load(path)
    assert found is None
    assert "stackloft_abi" in reason


@pytest.mark.parametrize("switch", ["0", "1"])
def test_the_environment_switches_them_off(switch):
    code = "from stackloft.compiled.library import *\nprint(kernels() is None, why_not(), sep='\\n')"
    environment = {**os.environ, "STACKLOFT_COMPILED": switch}
    run = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    off, reason = run.stdout.split("\n")[:2]
    said = reason == "the environment variable STACKLOFT_COMPILED is 0"
    assert said == (switch == "0")
    assert off == str(bool(reason))


def test_without_kernels_hides_them_from_the_whole_process_and_gives_them_back():
    before = library.kernels(), library.why_not()
    with library.without_kernels():
        with library.without_kernels():
            assert library.kernels() is None
        found = []
        thread = threading.Thread(target=lambda: found.append(library.kernels()))
        thread.start()
        thread.join()
        assert found == [None]
        assert library.why_not() == "hidden by without_kernels()"
    assert (library.kernels(), library.why_not()) == before


def test_they_come_back_after_an_error_too():
    before = library.why_not()
    with pytest.raises(ZeroDivisionError), library.without_kernels():
        1 / 0  # noqa: B018
    assert library.why_not() == before


def test_the_sources_are_beside_the_module_that_loads_them():
    assert (building.SOURCES / "abi.c").is_file()
    assert Path(library.__file__).parent == building.LIBRARY.parent
