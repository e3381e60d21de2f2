"""Listing plug-ins: by metadata alone."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from stackloft.model.errors import PluginError
from stackloft.registry import catalogue, find, locate
from stackloft.registry.scan import scan
from stackloft.testing.conformance.throwaway import installed

ROOT = Path(__file__).parents[2]

READER = """
    from dataclasses import dataclass
    from pathlib import Path
    from typing import ClassVar

    from stackloft.model.contour_stack import ContourStack

    @dataclass(frozen=True)
    class Reader:
        api: ClassVar[str] = "1"
        accepts: ClassVar[tuple[type, ...]] = (Path,)
        produces: ClassVar[tuple[type, ...]] = (ContourStack,)

        def probe(self, path):
            return 0.9 if path.suffix == ".acme" else 0.0

        def read(self, path):
            return ContourStack(())
"""


def test_lists_what_pyproject_registers():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]
    expected = {(group, name, target) for group, names in project.items() for name, target in names.items()}
    listed = {
        (f"stackloft.{x.family}s", x.name, x.target) for x in catalogue() if x.distribution == "stackloft"
    }
    assert listed == expected


def test_scans_once():
    catalogue()
    before = scan.cache_info().misses
    catalogue("reader")
    catalogue("writer")
    assert scan.cache_info().misses == before


def test_a_stranger_is_listed_without_being_imported(tmp_path):
    entry_points = {"stackloft.readers": {"acme": "acme_xct:Reader"}, "other.readers": {"x": "y:z"}}
    with installed(tmp_path, "acme-xct", entry_points, {"acme_xct": "raise SystemExit('imported')"}):
        (listing,) = [x for x in catalogue("reader") if x.distribution == "acme-xct"]
        assert (listing.name, listing.version, listing.target) == ("acme", "1.0", "acme_xct:Reader")
        assert "acme_xct" not in sys.modules
    assert not [x for x in catalogue() if x.distribution == "acme-xct"]


def test_loading_imports_the_one_asked_for(tmp_path):
    entry_points = {"stackloft.readers": {"one": "mod_one:Reader", "two": "mod_two:Reader"}}
    with installed(tmp_path, "acme", entry_points, {"mod_one": READER, "mod_two": READER}):
        assert find("reader", "one").plugin.__module__ == "mod_one"
        assert "mod_two" not in sys.modules


def test_unknown_family_and_name_say_what_there_is():
    with pytest.raises(PluginError, match="expected: reader, segmenter"):
        catalogue("printer")
    with pytest.raises(PluginError, match="no reconstructor is called 'lofft'; fix: did you mean loft"):
        find("reconstructor", "lofft")
    with pytest.raises(PluginError, match=r"fix: there is .*loft"):
        locate("reconstructor", "zzz")


def test_name_clash_names_both_and_the_qualified_name_chooses(tmp_path):
    for name in ("acme-a", "acme-b"):
        (tmp_path / name).mkdir()
    entry = {"stackloft.readers": {"xct": "{}:Reader"}}

    def points(module):
        return {
            group: {key: target.format(module) for key, target in names.items()}
            for group, names in entry.items()
        }

    with (
        installed(tmp_path / "acme-a", "acme-a", points("clash_a"), {"clash_a": READER}),
        installed(tmp_path / "acme-b", "acme-b", points("clash_b"), {"clash_b": READER}),
    ):
        with pytest.raises(PluginError, match=r"acme-a 1.0, acme-b 1.0; fix: .* acme-a:xct or acme-b:xct"):
            find("reader", "xct")
        assert find("reader", "acme-b:xct").plugin.__module__ == "clash_b"
        assert find("reader", "xct", prefer="acme-a").plugin.__module__ == "clash_a"
        keys = {x.key for x in catalogue("reader") if x.name == "xct"}
        assert keys == {"reader.acme-a:xct", "reader.acme-b:xct"}
    assert find("recipe", "loft").listing.clash == ()


def test_the_first_distribution_of_a_name_on_the_path_hides_the_second(tmp_path):
    entry = {"stackloft.readers": {"xct": "hidden:Reader"}}
    for number in ("1", "2"):
        (tmp_path / number).mkdir()
    with (
        installed(tmp_path / "1", "acme.xct", entry, {"hidden": READER}, "1.0"),
        installed(tmp_path / "2", "acme-XCT", entry, {}, "2.0"),
    ):
        assert locate("reader", "xct").version == "2.0"


def test_listing_takes_little_time():
    clock = "time.perf_counter()"
    code = f"import stackloft.registry as r, time; t={clock}; r.catalogue(); print({clock} - t)"
    output = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert float(output) < 0.5
