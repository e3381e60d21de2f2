"""The writer checks let the built-ins through and catch seeded faults, each by its name."""

import csv
import json
import tempfile
from dataclasses import dataclass, replace

import numpy as np
import pytest

from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.tri_mesh import TriMesh
from stackloft.registry import find
from stackloft.testing.conformance.check import findings
from stackloft.testing.conformance.writer_checks import CHECKS, WriterCase, writer_checks

STL, PLY, JSON, CSV = (find("writer", name).plugin for name in ("stl", "ply", "json", "csv"))


def json_figures(path):
    (body,) = json.loads(path.read_text())["objects"]
    return body["volume"]["value"], body["area"]["value"]


def csv_figures(path):
    rows = list(csv.DictReader(path.read_text().splitlines()))
    return [(float(row["z [mm]"]), float(row["area [mm^2]"])) for row in rows]


CASES = {
    "stl": WriterCase(STL),
    "ply": WriterCase(PLY),
    "json": WriterCase(JSON, json_figures, lambda x: (x.objects[0].volume.value, x.objects[0].area.value)),
    "csv": WriterCase(CSV, csv_figures, lambda x: [(row.z, row.area) for row in x.objects[0].sections]),
}


def spoilt(base, name, change, **members):
    """Return a writer of what `change` makes of the product."""

    def write(self, product, stream):
        base.write(self, change(product) if isinstance(product, TriMesh) else product, stream)

    return dataclass(frozen=True)(type(name, (base,), {"write": write, **members}))


def moved(change):
    return lambda mesh: replace(mesh, vertices=frozen_floats(change(mesh.vertices)))


def opened(mesh):
    return replace(mesh, faces=frozen_ints(mesh.faces[:-1]))


def turned(mesh):
    return replace(mesh, faces=frozen_ints(mesh.faces[:, ::-1]))


def closes(self, product, stream):
    PLY.write(self, product, stream)
    stream.close()


def drops_a_file(self, product, stream):
    with tempfile.NamedTemporaryFile("w") as log:
        log.write("written")
    PLY.write(self, product, stream)


def writes_anything(self, product, stream):
    stream.write(b"ply\n" + product.vertices.tobytes() if isinstance(product, TriMesh) else b"solid")


def says_when(self, product, stream):
    PLY.write(self, product, stream)
    stream.write(str(np.random.default_rng().random()).encode())


def same(mesh):
    return mesh


FAULTS = {
    spoilt(PLY, "Inches", moved(lambda v: v / 25.4)): "reads-back",
    spoilt(PLY, "AxesSwapped", moved(lambda v: v[:, ::-1])): "reads-back",
    spoilt(PLY, "OriginDropped", moved(lambda v: v - v.mean(axis=0))): "reads-back",
    spoilt(PLY, "InsideOut", turned): "reads-back",
    spoilt(PLY, "OneTriangleShort", opened): "reads-back",
    spoilt(PLY, "RoundedToHundredths", moved(lambda v: v.round(2))): "far-and-small",
    spoilt(PLY, "MirrorImage", moved(lambda v: v * [-1.0, 1.0, 1.0])): "reads-back",
    spoilt(PLY, "UpperCaseSuffix", same, suffixes=(".PLY",)): "plugin-shape",
    spoilt(PLY, "NoSuffix", same, suffixes=()): "plugin-shape",
    spoilt(PLY, "WritesAnything", same, write=writes_anything): "refuses-spoilt",
    spoilt(PLY, "ClosesTheStream", same, write=closes): "writes",
    spoilt(PLY, "DropsAFile", same, write=drops_a_file): "no-side-effects",
    spoilt(PLY, "SaysWhen", same, write=says_when): "writes",
    spoilt(PLY, "LeavesNothing", same, write=lambda self, product, stream: None): "writes",
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("check", CHECKS)
def test_the_built_ins_pass(name, check):
    next(each for each in writer_checks(CASES[name]) if each.name == check)()


@pytest.mark.parametrize("writer", FAULTS, ids=lambda kind: kind.__name__)
def test_seeded_faults_are_caught(writer):
    failed = {x.check: x.reason for x in findings(writer_checks(WriterCase(writer))) if not x.passed}
    assert failed.get(FAULTS[writer]), failed
