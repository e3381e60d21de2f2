"""Lofts of every topology by fTetWild: nothing turned over, V within 0.1 %, S within 0.2 % of the loft."""

import pytest

from stackloft.testing.phantoms.topology import TOPOLOGY
from stackloft_plugins.integrators.fem import Fem
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.meshers.tetwild import Tetwild
from stackloft_plugins.reconstructors.loft import LoftReconstructor


@pytest.mark.prove
def test_prove_every_topology(proof):
    rows = []
    for name, phantom in (next(item.phantoms()) for item in TOPOLOGY):
        solid = LoftReconstructor().reconstruct(phantom.contour_stack(sections=21))
        loft = SurfaceGauss().integrate(solid)
        mesh = Tetwild().mesh(solid)
        found, validity = Fem().integrate(mesh), mesh.validity()
        off = found.volume / loft.volume - 1, found.area / loft.area - 1
        rows.append(
            [
                name,
                f"{len(solid.shells)} shells, {len(solid.joints)} joints",
                len(mesh.elements),
                f"{validity.min_scaled_jacobian:.4f}",
                *(f"{part:+.1e}" for part in off),
                validity.inverted,
            ]
        )
        assert validity.inverted == 0, name
        assert abs(off[0]) <= 1e-3, name
        assert abs(off[1]) <= 2e-3, name
    proof(
        "tetwild-topology",
        "fem-tetwild on lofts of every topology, 21 sections, order 2: against the loft",
        ["body", "loft", "elements", "smallest scaled Jacobian", "error of V", "error of S", "turned over"],
        rows,
    )
