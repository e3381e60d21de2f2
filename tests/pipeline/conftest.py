"""A stranger's package with a whole small route: reader, reconstructor, integrators, methods."""

import json

import pytest

from stackloft.testing.conformance.throwaway import installed

SOURCE = """
import json
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from stackloft.contracts.options import option
from stackloft.contracts.recipe import Recipe
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.errors import InputError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.measurement import EndReport, Integral
from stackloft.model.notices import Notice
from stackloft.model.slice_stack import Hints
from stackloft.model.tri_mesh import TriMesh

CALLS = []
NOTICE = Notice("disk-like", "every section is a polygon")

class Plugin:
    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (ContourStack,)
    produces: ClassVar[tuple[type, ...]] = (Integral,)

@dataclass(frozen=True)
class DiskReader(Plugin):
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (ContourStack,)
    thickness: float | None = option(None, "pitch", unit="mm", gt=0)

    def probe(self, path):
        return 0.95 if path.suffix == ".disk" else 0.0

    def read(self, path):
        if self.thickness is None:
            raise InputError("unknown pitch", where=str(path), fix="--thickness")
        CALLS.append("read")
        said = json.loads(path.read_text())
        angle = 2 * np.pi * np.arange(said["points"]) / said["points"]
        ring = said["radius"] * np.column_stack([np.cos(angle), np.sin(angle)])
        loop = Loop(ring, np.arange(len(ring)))
        sections = tuple(Section(self.thickness * k, (loop,), f"{k}") for k in range(said["sections"]))
        hints = Hints(measured_weight=said.get("weight"))
        return ContourStack(sections, hints=hints, notices=(NOTICE,))

@dataclass(frozen=True)
class MeshReader(Plugin):
    accepts: ClassVar[tuple[type, ...]] = (Path,)
    produces: ClassVar[tuple[type, ...]] = (TriMesh,)
    def probe(self, path):
        return 0.95 if path.suffix == ".mesh" else 0.0
    def read(self, path):
        return TriMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))

@dataclass(frozen=True)
class Prism(Plugin):
    produces: ClassVar[tuple[type, ...]] = (LoftedSolid,)
    points: int = option(33, "points per loop", ge=4)
    stretch: float = option(1.0, "stretch", gt=0)

    def reconstruct(self, product):
        CALLS.append(f"prism {self.points} {self.stretch}")
        length = self.stretch * (product.positions[-1] - product.positions[0])
        area = product.sections[0].loops[0].signed_area
        ends = (EndReport("face", float(length), "given"), EndReport("face", float(area), "given"))
        return LoftedSolid((), ends, notices=(NOTICE, Notice("prism", f"stretch {self.stretch:g}")))

@dataclass(frozen=True)
class Product(Plugin):
    accepts: ClassVar[tuple[type, ...]] = (LoftedSolid,)
    factor: float = option(1.0, "factor", gt=0)
    limit: float | None = option(5000.0, "largest volume; none: no limit", gt=0)

    def integrate(self, product):
        length, area = (end.length for end in product.ends)
        volume = self.factor * length * area
        return Integral(volume if self.limit is None else min(self.limit, volume), 2 * area)

@dataclass(frozen=True)
class Plain(Plugin):
    def integrate(self, product):
        z = product.positions
        return Integral(float(z[-1] - z[0]) * product.sections[0].loops[0].signed_area, None)

@dataclass(frozen=True)
class AreaOnly(Plugin):
    def integrate(self, product):
        return Integral(None, 7.0)

@dataclass(frozen=True)
class MeshVolume(Plugin):
    accepts: ClassVar[tuple[type, ...]] = (TriMesh,)
    def integrate(self, product):
        return Integral(5.0, 6.0)

def fails(error):
    @dataclass(frozen=True)
    class Fails(Plugin):
        def integrate(self, product):
            CALLS.append("fails")
            raise error
    return Fails

def gives(value):
    @dataclass(frozen=True)
    class Gives(Plugin):
        def integrate(self, product):
            return value
    return Gives

Refuses, Crashes = fails(InputError("too thin")), fails(RuntimeError("boom"))
GivesText, GivesNan = gives("text"), gives(Integral(float("nan"), 1.0))
GivesZero = gives(Integral(0.0, 1.0))
GivesMinus = gives(Integral(-3.0, 1.0))

prism = Recipe(("reconstructor.prism", "integrator.product"), "prism")
long_prism = Recipe(
    ("reconstructor.prism", "integrator.product"), "long", {"reconstructor.prism": {"stretch": 2.0}}
)
surface = Recipe(("integrator.mesh-volume",), "of a surface")
plain = Recipe(("integrator.plain",), "volume alone")
area_only = Recipe(("integrator.area-only",), "area alone")
refuses = Recipe(("integrator.refuses",), "refuses")
crashes = Recipe(("integrator.crashes",), "crashes")
text = Recipe(("integrator.gives-text",), "")
nan = Recipe(("integrator.gives-nan",), "")
minus = Recipe(("integrator.gives-minus",), "")
refuses_again = Recipe(("integrator.refuses",), "the same once more")
zero = Recipe(("integrator.gives-zero",), "")
upside_down = Recipe(("integrator.product", "reconstructor.prism"), "wrong order")
endless = Recipe(("reconstructor.prism",), "no integrator")
typo = Recipe(("integrator.plain",), "", {"integrator.plain": {"ruel": 1}})
"""
METHODS = (
    "prism",
    "long_prism",
    "plain",
    "surface",
    "area_only",
    "refuses",
    "crashes",
    "text",
    "nan",
    "zero",
)
NAMES = {
    "readers": {"disk": "DiskReader", "mesh": "MeshReader"},
    "reconstructors": {"prism": "Prism"},
    "integrators": {
        "product": "Product",
        "plain": "Plain",
        "mesh-volume": "MeshVolume",
        "area-only": "AreaOnly",
        "refuses": "Refuses",
        "crashes": "Crashes",
        "gives-text": "GivesText",
        "gives-nan": "GivesNan",
        "gives-zero": "GivesZero",
        "gives-minus": "GivesMinus",
    },
    "recipes": {
        name.replace("_", "-"): name
        for name in (*METHODS, "minus", "refuses_again", "upside_down", "endless", "typo")
    },
}
POINTS = {
    f"stackloft.{group}": {name: f"disk_house:{target}" for name, target in names.items()}
    for group, names in NAMES.items()
}


@pytest.fixture
def house(tmp_path):
    """Install the package; return its module."""
    site = tmp_path / "site"
    site.mkdir()
    with installed(site, "disk-house", POINTS, {"disk_house": SOURCE}):
        import disk_house  # noqa: PLC0415 - it is installed only now

        yield disk_house


@pytest.fixture
def disk(tmp_path):
    """Return a source: a square prism of side √2·10 mm in 5 sections."""
    path = tmp_path / "body.disk"
    path.write_text(json.dumps({"radius": 10.0, "points": 4, "sections": 5, "weight": 1.0}))
    return path
