"""Checks of meshers; run them with one pytest call.

::

    @pytest.mark.parametrize("check", mesher_checks(MesherCase(MyMesher)), ids=str)
    def test_my_mesher(check):
        check()
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from stackloft.geometry.tet_integrals import elements_volume, exact_volume_degree, faces_area
from stackloft.model.arrays import FloatArray, frozen_floats
from stackloft.model.errors import StackloftError
from stackloft.model.lofted_solid import LoftedSolid
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tet_mesh_check import check_tet_mesh
from stackloft.registry.options_model import validate
from stackloft.testing.conformance import ellipsoids
from stackloft.testing.conformance.adding import must_add_up
from stackloft.testing.conformance.check import Check, NonconformingError, must, must_refuse, suite
from stackloft.testing.conformance.comparing import must_be_frozen, must_be_same
from stackloft.testing.conformance.moving import emptied, opened, started_elsewhere, transformed
from stackloft.testing.conformance.option_checks import check_options, check_shape

FINENESS = (1, 2, 3)
"""Resolutions of the body on which convergence is judged."""
_TURN = np.array([[0.0, -0.8, 0.6], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8]])
_SHIFT = np.array([5.0, -90.0, 77.0])


@dataclass(frozen=True, slots=True)
class MesherCase:
    """One mesher and what may be asked of it."""

    mesher: type[Any]
    options: Mapping[str, Any] = field(default_factory=dict)
    steadiness: float = 1e-3
    """Relative change of volume and area allowed where nothing should change."""
    volume_tolerance: float = 0.03
    """Relative error allowed on the finest body."""
    area_tolerance: float = 0.03
    settled: float = 0.01
    """Relative error below which a finer body need not do better."""
    place_tolerance: float = 0.1
    """mm by which the mesh's centre may be off; the body's axes are 14, 8, 8 mm."""

    def mesh(self, product: Any) -> Any:
        """Return the tetrahedra."""
        values = validate(self.mesher, self.options, self.mesher.__name__)
        return self.mesher(**values).mesh(product)

    def figures(self, product: Any) -> tuple[float, float, FloatArray]:
        """Return volume, area and centre of the mesh of `product`."""
        return figures_of(self.mesh(product))

    def bodies(self, fineness: int = 2) -> list[Any]:
        """Return the ellipsoid as each product type that is accepted and that the kit can make."""
        fitting = [make for kind, make in ellipsoids.MAKERS.items() if kind in self.mesher.accepts]
        must(fitting, f"the kit has no body of a type in {self.mesher.accepts}")
        return [make(fineness) for make in fitting]


def figures_of(mesh: Any) -> tuple[float, float, FloatArray]:
    """Return volume, area and the middle of the straight elements, by volume."""
    must(isinstance(mesh, TetMesh), f"{type(mesh).__name__} is returned, not a TetMesh")
    corners = mesh.nodes[mesh.elements[:, :4]]
    parts = np.linalg.det(corners[:, 1:] - corners[:, :1])
    centre = (corners.mean(axis=1) * parts[:, None]).sum(axis=0) / parts.sum()
    volume = elements_volume(mesh.nodes, mesh.elements, exact_volume_degree(mesh.order))
    return volume, faces_area(mesh.nodes, mesh.faces, 6), np.asarray(centre)


def shape(case: MesherCase) -> None:
    """Check that the registry lets the mesher in."""
    check_shape("mesher", case.mesher)


def options(case: MesherCase) -> None:
    """Check that options are declared, bounded and refused when wrong."""
    check_options(case.mesher, case.options)


def meshes(case: MesherCase) -> None:
    """Check that a frozen TetMesh comes out, with the same figures again, and the input stays as it was."""
    for body, fresh in zip(case.bodies(), case.bodies(), strict=True):
        mesh = case.mesh(body)
        must(isinstance(mesh, TetMesh), f"{type(mesh).__name__} is returned, not a TetMesh")
        must_be_frozen(mesh)
        first, second = figures_of(mesh), case.figures(body)
        _must_agree(case, first, second, 1.0, "meshing again")
        must_be_same(body, fresh, "after it was meshed")


def valid(case: MesherCase) -> None:
    """Check that every element is positive everywhere, and the boundary whole, closed and outward."""
    for body in case.bodies():
        try:
            check_tet_mesh(case.mesh(body))
        except StackloftError as error:
            message = f"the mesh of a {type(body).__name__} is not valid: {error}"
            raise NonconformingError(message) from error


def place(case: MesherCase) -> None:
    """Check that the mesh lies where the body lies."""
    for body in case.bodies(max(FINENESS)):
        off = float(np.linalg.norm(case.figures(body)[2] - ellipsoids.CENTRE))
        must(off <= case.place_tolerance, f"the mesh's centre lies {off:.3g} mm off")


def convergence(case: MesherCase) -> None:
    """Check that volume and area approach the exact ones as patches or triangles get finer."""
    for kind in [type(body) for body in case.bodies()]:
        runs = [case.figures(ellipsoids.MAKERS[kind](fineness)) for fineness in FINENESS]
        for name, which, exact, tolerance in (
            ("volume", 0, ellipsoids.VOLUME, case.volume_tolerance),
            ("area", 1, ellipsoids.AREA, case.area_tolerance),
        ):
            errors = [abs(float(run[which]) / exact - 1.0) for run in runs]
            told = f"{name} from {kind.__name__} errs by {', '.join(f'{error:.2e}' for error in errors)}"
            must(errors[-1] <= tolerance, f"{told}: more than {tolerance:g} at the finest")
            finer = all(b <= max(a, case.settled) for a, b in pairwise(errors))
            must(finer, f"{told}: not less as the body gets finer")


def rigid_motion(case: MesherCase) -> None:
    """Check that a moved and turned body keeps its figures, and that its mesh is where it was moved to."""
    for body in case.bodies():
        before, after = case.figures(body), case.figures(transformed(body, _TURN, _SHIFT))
        _must_agree(case, before, after, 1.0, f"a rigid motion of a {type(body).__name__}")
        off = float(np.linalg.norm(after[2] - (_TURN @ before[2] + _SHIFT)))
        must(off <= case.place_tolerance, f"a moved body's mesh lies {off:.3g} mm from where it was moved to")


def affine_motion(case: MesherCase) -> None:
    """Check that a solid's affine is honoured: the mesh is in bench millimetres."""
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = _TURN, _SHIFT
    for body in case.bodies():
        if isinstance(body, LoftedSolid):
            before = case.figures(body)
            after = case.figures(replace(body, affine=frozen_floats(move)))
            _must_agree(case, before, after, 1.0, "an affine that turns")
            off = float(np.linalg.norm(after[2] - (_TURN @ before[2] + _SHIFT)))
            must(off <= case.place_tolerance, f"the affine is not honoured: the mesh lies {off:.3g} mm off")


def scaling(case: MesherCase) -> None:
    """Check that a body s times as large has s³ the volume and s² the area."""
    for body in case.bodies():
        for s in (1e-2, 2.5, 1e2):
            other = case.figures(transformed(body, s * np.eye(3), np.zeros(3)))
            _must_agree(case, case.figures(body), other, s, f"scaling a {type(body).__name__} by {s:g}")


def mirror(case: MesherCase) -> None:
    """Check that a mirrored body has the same figures, and elements that are not turned over."""
    for body in case.bodies():
        other = case.mesh(transformed(body, np.diag([-1.0, 1.0, 1.0]), np.zeros(3)))
        must(
            isinstance(other, TetMesh) and not other.validity().inverted,
            "a mirrored body's elements are turned over",
        )
        _must_agree(case, case.figures(body), figures_of(other), 1.0, f"mirroring a {type(body).__name__}")


def start_point(case: MesherCase) -> None:
    """Check that where a loop of patches, or a list of vertices, starts changes nothing."""
    for body in case.bodies():
        for steps in (1, 3):
            other = case.figures(started_elsewhere(body, steps))
            _must_agree(case, case.figures(body), other, 1.0, f"starting {steps} later")


def additivity(case: MesherCase) -> None:
    """Check that two bodies in one product have the sum of their figures, or are refused."""
    for body in case.bodies():
        must_add_up(body, lambda product: case.figures(product)[:2], case.steadiness)


def refusals(case: MesherCase) -> None:
    """Check that a body of nothing is refused."""
    for body in case.bodies():
        what = f"an empty {type(body).__name__}"
        must_refuse(lambda body=body: case.mesh(emptied(body)), what)  # type: ignore[misc]


def open_bodies(case: MesherCase) -> None:
    """Check that a solid or surface with a piece missing is refused, not filled."""
    for body in case.bodies():
        what, gap = opened(body)
        must_refuse(lambda gap=gap: case.mesh(gap), what)  # type: ignore[misc]


def _must_agree(
    case: MesherCase,
    before: tuple[float, float, FloatArray],
    after: tuple[float, float, FloatArray],
    s: float,
    what: str,
) -> None:
    for name, which, power in (("volume", 0, 3), ("area", 1, 2)):
        change = float(after[which]) / (float(before[which]) * s**power) - 1.0
        told = f"{what} changes the {name} by {change:.1e} (of s^{power})"
        must(abs(change) <= case.steadiness, told)


CHECKS = {
    "plugin-shape": shape,
    "options-validated": options,
    "meshes": meshes,
    "valid": valid,
    "place": place,
    "convergence": convergence,
    "rigid-motion": rigid_motion,
    "affine-motion": affine_motion,
    "scaling": scaling,
    "mirror": mirror,
    "start-point": start_point,
    "additivity": additivity,
    "refuses-empty": refusals,
    "refuses-open": open_bodies,
}


def mesher_checks(case: MesherCase, expected_failures: Mapping[str, str] | None = None) -> list[Check]:
    """Return the checks of one mesher.

    Parameters
    ----------
    case : MesherCase
        The mesher, its options and tolerances.
    expected_failures : mapping, optional
        Reasons by check for those that this mesher may break; it must then really break them.
    """
    return suite(CHECKS, case, expected_failures or {})
