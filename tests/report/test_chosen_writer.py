"""A writer is found, gets its settings, and answers for its failures."""

import io
from dataclasses import dataclass
from typing import ClassVar

import pytest

from stackloft.model.errors import InputError, PluginError, UsageError
from stackloft.model.tri_mesh import TriMesh
from stackloft.registry import Listing, Loaded
from stackloft.report.chosen_writer import ChosenWriter, solid_writers


@dataclass(frozen=True)
class Failing:
    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TriMesh,)
    produces: ClassVar[tuple[type, ...]] = ()
    suffixes: ClassVar[tuple[str, ...]] = (".xyz",)

    def write(self, product, stream):
        stream.write(b"half")
        message = "no\nsuch thing"
        raise LookupError(message)


def test_a_strangers_failure_names_the_stranger():
    chosen = ChosenWriter(
        Loaded(Listing("writer", "xyz", "acme-xyz", "1.2", "acme:Failing"), Failing), Failing()
    )
    with pytest.raises(PluginError, match=r"acme-xyz 1\.2 failed.*LookupError"):
        chosen.write(None, io.BytesIO())


def test_the_more_particular_setting_wins():
    settings = {
        "writer": {"tolerance": "1mm"},
        "stl": {"tolerance": "2mm"},
        "writer.stl": {"tolerance": "3mm"},
    }
    stl, ply = solid_writers(("stl", "ply"), settings)
    assert (stl.instance.tolerance, ply.instance.tolerance) == (3.0, 1.0)
    assert (stl.suffix, ply.suffix) == (".stl", ".ply")


@pytest.mark.parametrize(
    ("names", "settings", "words"),
    [
        (("json",), {}, "writes no solid"),
        (("stl",), {"ply": {"tolerance": 1}}, "add --write ply"),
        ((), {"writer": {"tolerance": 1}}, "writes nothing"),
        (("stl",), {"stl": {"tolerance": -1}}, "tolerance"),
    ],
)
def test_what_makes_no_sense_is_wrong_usage(names, settings, words):
    with pytest.raises(UsageError, match=words):
        solid_writers(names, settings)


def test_a_run_without_a_solid_is_refused():
    with pytest.raises(InputError, match="no solid to write"):
        ChosenWriter.of("stl").fitting(["text", 3])
