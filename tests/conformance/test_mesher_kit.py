"""The mesher checks let the built-in sweep through and catch seeded faults, each by its name."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from stackloft.model.arrays import frozen_floats, frozen_ints
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tet_mesh import TetMesh
from stackloft.registry import find
from stackloft.testing.conformance.check import findings
from stackloft.testing.conformance.mesher_checks import CHECKS, MesherCase, mesher_checks

SWEEP = find("mesher", "sweep").plugin
SMALL = {"elements": 1500}


def spoilt(name, after=lambda x: x, before=lambda x: x):
    """Return a mesher that works on `before` of its solid and gives `after` of its mesh."""

    def mesh(self, solid):
        return after(SWEEP.mesh(self, before(solid)))

    return dataclass(frozen=True)(type(name, (SWEEP,), {"mesh": mesh}))


def moved(change):
    return lambda mesh: replace(mesh, nodes=frozen_floats(change(mesh.nodes)))


def rewired(**changes):
    return lambda mesh: replace(mesh, **{key: frozen_ints(change(mesh)) for key, change in changes.items()})


def jittered(nodes):
    return nodes * np.random.default_rng().uniform(0.98, 1.02)


def folded(mesh):
    """Push one edge node of an inner element through the opposite side."""
    nodes = mesh.nodes.copy()
    inner = np.setdiff1d(mesh.elements[:, 4:], mesh.faces)[0]
    nodes[inner] += 3.0 * np.ptp(nodes, axis=0) / 10
    return replace(mesh, nodes=frozen_floats(nodes))


def patched_up(solid):
    """Close a gap silently by carrying the last column on."""
    shells = tuple(
        replace(
            shell,
            patches=frozen_floats(
                np.concatenate(
                    [shell.patches[:, :, :, :3], np.roll(shell.patches, -1, axis=1)[:, :, :, :1]], axis=3
                )
            ),
        )
        for shell in solid.shells
    )
    return replace(solid, shells=shells)


def something_for_nothing(self, solid):
    if not solid.shells:
        return TetMesh(np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 1, 2, 3]]), np.array([[0, 2, 1]]))
    return SWEEP.mesh(self, solid)


FAULTS = {
    spoilt("InsideOut", rewired(elements=lambda m: m.elements[:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]])): "valid",
    spoilt("OneFaceShort", rewired(faces=lambda m: m.faces[:-1], groups=lambda m: m.groups[:-1])): "valid",
    spoilt("OneElementShort", rewired(elements=lambda m: m.elements[:-1])): "valid",
    spoilt("OneElementTwice", rewired(elements=lambda m: np.vstack([m.elements, m.elements[:1]]))): "valid",
    spoilt("FacesInward", rewired(faces=lambda m: m.faces[:, [0, 2, 1, 5, 4, 3]])): "valid",
    spoilt("Folded", folded): "valid",
    spoilt("OriginDropped", moved(lambda x: x - x.min(axis=0))): "place",
    spoilt("Shrunk", moved(lambda x: x.mean(axis=0) + 0.97 * (x - x.mean(axis=0)))): "convergence",
    spoilt("Jittered", moved(jittered)): "meshes",
    spoilt("Metres", moved(lambda x: x / 1000)): "convergence",
    spoilt("AffineForgotten", before=lambda s: replace(s, affine=frozen_floats(np.eye(4)))): "affine-motion",
    spoilt("FixedStep", moved(lambda x: np.round(x, 1))): "scaling",
    spoilt("Writable", lambda m: replace(m, nodes=m.nodes.copy())): "meshes",
    spoilt("GapsClosed", before=patched_up): "refuses-open",
    dataclass(frozen=True)(type("Something", (SWEEP,), {"mesh": something_for_nothing})): "refuses-empty",
    spoilt("OneBodyOfTwo", before=lambda s: replace(s, shells=s.shells[:1])): "additivity",
    spoilt("AxisAligned", moved(lambda x: x * [1.0, 1.0, 1.01])): "rigid-motion",
}


@pytest.mark.parametrize("check", mesher_checks(MesherCase(SWEEP, SMALL)), ids=str)
def test_sweep_passes(check):
    check()


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_seeded_faults_are_caught(fault):
    assert FAULTS[fault] in CHECKS
    case = MesherCase(fault, SMALL, steadiness=1e-3)
    check = next(x for x in mesher_checks(case) if x.name == FAULTS[fault])
    assert not check.finding().passed


def test_a_mesher_is_found_by_its_name():
    from stackloft.testing.conformance.suites import checks_of  # noqa: PLC0415

    assert [check.name for check in checks_of("mesher.sweep")] == list(CHECKS)
    assert LoftedSolid in SWEEP.accepts
    assert all(item.passed for item in findings(mesher_checks(MesherCase(SWEEP, SMALL))[:2]))
