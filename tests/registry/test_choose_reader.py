"""Which reader a path is meant for."""

import pytest

from stackloft.model.errors import InputError, PluginError
from stackloft.registry import choose_reader, describe, probe_all
from stackloft.testing.conformance.throwaway import installed

SOURCE = """
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar
from stackloft.model.contour_stack import ContourStack

@dataclass(frozen=True)
class Base:
    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (ContourStack,)
    def probe(self, path): return answer(self, path)
    def read(self, path): return ContourStack(())

def answer(self, path):
    magic = path.read_bytes()[:4] if path.is_file() else b""
    return {"A": {b"ACME": 0.9, b"BOTH": 0.5}, "B": {b"BOTH": 0.5}}[type(self).__name__].get(magic, 0.0)

class A(Base): pass
class B(Base): pass
class Raises(Base):
    def probe(self, path): raise OSError("disk")
class Sure(Base):
    def probe(self, path): return 7.0
class Nan(Base):
    def probe(self, path): return float("nan")
"""
POINTS = {name.lower(): f"acme_probe:{name}" for name in ("A", "B", "Raises", "Sure", "Nan")}


@pytest.fixture
def acme(tmp_path):
    site = tmp_path / "site"
    site.mkdir()
    with installed(site, "acme-probe", {"stackloft.readers": POINTS}, {"acme_probe": SOURCE}):
        yield tmp_path


def test_the_surest_wins_by_content(acme):
    path = acme / "scan.bin"
    path.write_bytes(b"ACME....")
    assert choose_reader(path).name == "a"


def test_a_tie_names_both(acme):
    path = acme / "scan.bin"
    path.write_bytes(b"BOTH....")
    with pytest.raises(PluginError, match=r"readers a and b are equally sure .*--reader a or --reader b"):
        choose_reader(path)
    assert choose_reader(path, "b").name == "b"


def test_nobody_says_what_was_found_and_who_failed(acme):
    path = acme / "scan.xyz"
    path.write_bytes(b"....")
    with pytest.raises(InputError) as caught:
        choose_reader(path)
    text = str(caught.value)
    assert "a file .xyz of 4 bytes" in text
    assert "reader.raises: its probe failed: OSError: disk" in text
    assert "reader.sure: its probe answered 7" in text
    assert "reader.nan: its probe answered nan" in text


def test_a_probe_that_fails_does_not_hide_the_others(acme):
    path = acme / "scan.bin"
    path.write_bytes(b"ACME")
    faults = {probe.reader.name for probe in probe_all(path) if probe.fault}
    assert faults == {"raises", "sure", "nan"}


def test_missing_path_offers_the_nearest(tmp_path):
    (tmp_path / "apple_1").mkdir()
    with pytest.raises(InputError, match="appel_1: no such file or folder; fix: did you mean apple_1"):
        choose_reader(tmp_path / "appel_1")
    with pytest.raises(InputError, match=r"no such file or folder$"):
        choose_reader(tmp_path / "far" / "away")


def test_named_reader_on_a_missing_path(acme):
    with pytest.raises(InputError, match="no such file or folder"):
        choose_reader(acme / "nothing", "a")


def test_empty_folder(tmp_path):
    with pytest.raises(InputError, match="nothing to read: an empty folder"):
        choose_reader(tmp_path)


def test_description_counts_suffixes(tmp_path):
    for name in ("a.xyz", "b.XYZ", "c", "d.q"):
        (tmp_path / name).write_text("")
    (tmp_path / "sub").mkdir()
    assert describe(tmp_path) == "4 files: 2 × .xyz, 1 × .q, 1 × without suffix, 1 folder"
    assert describe(tmp_path / "a.xyz") == "an empty file"
