"""Gmsh's OpenCASCADE loft with tetrahedra of order 2, beside sweep and tetwild, on the same sections."""

import os
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")

import gmsh
import numpy as np

from stackloft.geometry.lagrange_simplex import TET_NODES
from stackloft.geometry.tet_boundary import boundary_faces
from stackloft.geometry.tet_integrals import elements_volume, faces_area
from stackloft.geometry.tet_jacobian import jacobian_bounds
from stackloft.testing import phantoms
from stackloft_plugins.integrators.surface_gauss import SurfaceGauss
from stackloft_plugins.meshers.sweep import Sweep
from stackloft_plugins.meshers.tetwild import Tetwild
from stackloft_plugins.reconstructors.loft import LoftReconstructor

BODIES = ("ellipsoid", "potato")
ELEMENTS = 5000
POINTS = 33


def gmsh_loft(stack, size):
    """Closed splines through 33 points of every section, ThruSections between them, flat ends; order 2."""
    gmsh.initialize(["gmsh", "-nopopup"], interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.3 * size)
    gmsh.option.setNumber("Mesh.SecondOrderLinear", 0)
    gmsh.option.setNumber("Mesh.HighOrderOptimize", 2)
    occ, start = gmsh.model.occ, time.perf_counter()
    wires = []
    for section in stack.sections:
        loop = section.loops[0].points
        ring = loop[np.linspace(0, len(loop), POINTS, endpoint=False).astype(int)]
        tags = [occ.addPoint(*point, section.z) for point in ring.tolist()]
        wires.append(occ.addWire([occ.addBSpline([*tags, tags[0]])]))
    occ.addThruSections(wires, makeSolid=True)
    occ.synchronize()
    exact = occ.getMass(3, gmsh.model.getEntities(3)[0][1])
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    seconds = time.perf_counter() - start
    tags, points, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    place[tags.astype(np.int64)] = np.arange(len(tags))
    kinds, _, index = gmsh.model.mesh.getElements(3)
    elements = place[index[list(kinds).index(11)].astype(np.int64)].reshape(-1, TET_NODES[2])
    gmsh.finalize()
    return points.reshape(-1, 3), elements[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]], seconds, exact


def line(name, nodes, elements, seconds, volume, area, loft):
    low = jacobian_bounds(nodes[elements]).low
    found = elements_volume(nodes, elements, 4)
    surface = faces_area(nodes, boundary_faces(elements), 10)
    print(
        f"  {name:22s} {len(elements):6d} elements {seconds:7.2f} s  V {found / volume - 1:+.1e} of the body,"
        f" {found / loft - 1:+.1e} of its own loft  S {surface / area - 1:+.1e}"
        f"  {int((low <= 0).sum())} turned over, smallest scaled Jacobian {low.min():.3f}"
    )


def main():
    for name in BODIES:
        body = phantoms.make(name)
        stack = body.contour_stack(sections=11)
        print(f"{name}, 11 exact sections:")
        solid = LoftReconstructor(height=body.height).reconstruct(stack)
        loft = SurfaceGauss().integrate(solid)
        for label, mesher in (
            ("sweep, order 2", Sweep(elements=ELEMENTS)),
            ("tetwild, order 2", Tetwild(elements=ELEMENTS)),
        ):
            start = time.perf_counter()
            mesh = mesher.mesh(solid)
            line(
                label,
                mesh.nodes,
                mesh.elements,
                time.perf_counter() - start,
                body.volume,
                body.area,
                loft.volume,
            )
        size = (0.7 * body.volume / (0.118 * ELEMENTS)) ** (1 / 3)
        nodes, elements, seconds, exact = gmsh_loft(stack, size)
        line("gmsh OCC loft, order 2", nodes, elements, seconds, body.volume, body.area, exact)


if __name__ == "__main__":
    main()
