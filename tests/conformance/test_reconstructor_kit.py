"""The reconstructor checks let the built-ins through and catch seeded faults, each by its name."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.contour_stack import Loop
from stackloft.model.tri_mesh import TriMesh
from stackloft.registry import find
from stackloft.testing.conformance.check import findings
from stackloft.testing.conformance.reconstructor_checks import CHECKS, ReconstructorCase, reconstructor_checks
from stackloft_plugins.conformance import CASES

LOFT, ISOSURFACE, SHAPES = (
    find("reconstructor", name).plugin for name in ("loft", "isosurface", "shape-interpolation")
)


def spoilt(base, name, after=lambda x: x, before=lambda x: x):
    """Return a reconstructor that works on `before` of its product and gives `after` of its result."""

    def reconstruct(self, product):
        return after(base.reconstruct(self, before(product)))

    return dataclass(frozen=True)(type(name, (base,), {"reconstruct": reconstruct}))


def moved(change):
    return lambda mesh: replace(mesh, vertices=frozen_floats(change(mesh.vertices)))


def rewound(change):
    return lambda mesh: replace(mesh, faces=frozen_ints(change(mesh.faces)))


def loops(change):
    """Return the fault of a product whose loops go through `change` before they are used."""

    def all_of(stack):
        sections = tuple(
            replace(s, loops=tuple(replace(x, points=frozen_floats(change(x.points))) for x in s.loops))
            for s in stack.sections
        )
        return replace(stack, sections=sections)

    return all_of


def level_positions(stack):
    sections = tuple(replace(s, z=stack.sections[0].z + 2.0 * k) for k, s in enumerate(stack.sections))
    return replace(stack, sections=sections)


def left_alone(stack):
    return replace(stack, affine=frozen_floats(np.eye(4)))


def unit_spacing(segmentation):
    stack = segmentation.stack
    return replace(
        segmentation, stack=replace(stack, pixel_spacing=frozen_floats(np.ones_like(stack.pixel_spacing)))
    )


def jittered(points):
    return points + np.random.default_rng().normal(0.0, 0.01, points.shape)


def first_quadrant(stack):
    def kept(loop):
        return Loop(frozen_floats(np.maximum(loop.points, stack.sections[0].loops[0].points.min(axis=0))))

    return replace(stack, sections=tuple(replace(s, loops=tuple(map(kept, s.loops))) for s in stack.sections))


def first_loops(stack):
    return replace(stack, sections=tuple(replace(s, loops=s.loops[:1]) for s in stack.sections))


@dataclass(frozen=True)
class HandsOn:
    """Gives back whatever surface it gets."""

    api: ClassVar[str] = "1"
    accepts: ClassVar[tuple[type, ...]] = (TriMesh,)
    produces: ClassVar[tuple[type, ...]] = (TriMesh,)

    def reconstruct(self, product):
        return product


FAULTS = {
    spoilt(ISOSURFACE, "InsideOut", rewound(lambda f: f[:, ::-1])): "closed",
    spoilt(ISOSURFACE, "OneTriangleShort", rewound(lambda f: f[:-1])): "closed",
    spoilt(ISOSURFACE, "OneTriangleTurned", rewound(lambda f: np.vstack([f[:-1], f[-1:, ::-1]]))): "closed",
    spoilt(ISOSURFACE, "OriginDropped", moved(lambda v: v - v.min(axis=0))): "place",
    spoilt(ISOSURFACE, "HalfASlice", moved(lambda v: v + [0.0, 0.0, 0.33])): "place",
    spoilt(ISOSURFACE, "AxesSwapped", moved(lambda v: v[:, ::-1])): "place",
    spoilt(ISOSURFACE, "Centimetres", moved(lambda v: v / 10.0)): "convergence",
    spoilt(ISOSURFACE, "UnitSpacing", before=unit_spacing): "convergence",
    spoilt(ISOSURFACE, "Stretched", moved(lambda v: v * [1.0, 1.0, 1.1])): "convergence",
    spoilt(ISOSURFACE, "NotANumber", moved(lambda v: np.where(v == v.max(), np.nan, v))): "closed",
    spoilt(ISOSURFACE, "Vertices", lambda mesh: mesh.vertices): "reconstructs",
    spoilt(ISOSURFACE, "Dice", moved(jittered)): "reconstructs",
    spoilt(LOFT, "AffineIgnored", before=left_alone): "affine",
    spoilt(LOFT, "PositionsCounted", before=level_positions): "scaling",
    spoilt(LOFT, "SmallPiecesRounded", before=loops(lambda p: p.round(1))): "scaling",
    spoilt(LOFT, "StartPointForgotten", before=loops(lambda p: p[3:])): "start-point",
    spoilt(LOFT, "CutAtTheFirst", before=first_quadrant): "convergence",
    spoilt(LOFT, "MirrorLost", before=loops(np.abs)): "place",
    spoilt(LOFT, "OneBodyOfTwo", before=first_loops): "additivity",
    HandsOn: "open",
}


@pytest.mark.parametrize("reconstructor", [LOFT, ISOSURFACE, SHAPES], ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("name", CHECKS)
def test_the_built_ins_pass(reconstructor, name):
    expected = CASES["reconstructor.shape-interpolation"]["expected_failures"]
    told = expected if reconstructor is SHAPES else {}
    checks = reconstructor_checks(ReconstructorCase(reconstructor), told)
    next(check for check in checks if check.name == name)()


@pytest.mark.parametrize("reconstructor", FAULTS, ids=lambda kind: kind.__name__)
def test_seeded_faults_are_caught(reconstructor):
    checks = reconstructor_checks(ReconstructorCase(reconstructor))
    told = next(x for x in findings([c for c in checks if c.name == FAULTS[reconstructor]]))
    assert not told.passed, told
    assert told.reason
