r"""Transient cooling of a reconstructed piece: heat conduction by scikit-fem on stackloft's own mesh.

::

    ρc ∂T/∂t = ∇·(k ∇T)  in the body,   −k ∂T/∂n = h (T − T∞)  on its surface,   T = T₀ at t = 0

Run it from the repository: ``python docs/examples/cooling.py sample_stacks/meat docs/cooling.png``
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree
from skfem import Basis, BilinearForm, ElementTetP2, MeshTet, MeshTet2
from skfem.helpers import dot, grad

from stackloft import TetMesh
from stackloft.geometry.lagrange_simplex import shape_slopes, shape_values
from stackloft.geometry.simplex_gauss import simplex_gauss

# meat: conductivity W/(m K), density kg/m³, specific heat J/(kg K); air in a chiller W/(m² K)
K, RHO_C, H = 0.47, 1070.0 * 3450.0, 25.0
T0, T_AIR = 35.0, 2.0
HOURS = 2.0


def skfem_mesh(mesh: TetMesh) -> tuple[MeshTet2, np.ndarray]:
    """Return scikit-fem's mesh of order 2, in metres, and which of its degrees of freedom is which node."""
    corners, straight = np.unique(mesh.elements[:, :4], return_inverse=True)
    plain = MeshTet(1e-3 * mesh.nodes[corners].T, straight.reshape(-1, 4).T)
    curved = MeshTet2.from_mesh(plain)
    edge = {}
    for (a, b), column in zip(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)), range(4, 10), strict=True):
        pairs = np.sort(mesh.elements[:, (a, b)], axis=1).tolist()
        edge.update(zip(map(tuple, pairs), mesh.elements[:, column].tolist(), strict=True))
    own = [edge[tuple(sorted(pair))] for pair in corners[plain.edges.T].tolist()]
    node = np.concatenate(
        [corners, own]
    )  # vertices first, then edges: the order of scikit-fem's ElementTetP2
    return MeshTet2(doflocs=1e-3 * mesh.nodes[node].T, t=curved.t), node


def skin(mesh: TetMesh, node: np.ndarray) -> tuple[coo_array, np.ndarray]:
    """Return ∫ u v dA and ∫ v dA over the boundary, m², by the degrees of freedom of `skfem_mesh`.

    Over stackloft's own boundary faces: scikit-fem's facet basis inverts the map of each curved element by
    Newton's method, which does not always converge.
    """
    place = np.empty(len(node), dtype=np.int64)
    place[node] = np.arange(len(node))
    points, weights = simplex_gauss(2, 6)
    shapes, slopes = shape_values(2, 2, points), shape_slopes(2, 2, points)
    faces = 1e-3 * mesh.nodes[mesh.faces]
    area = np.linalg.norm(np.cross(slopes[0] @ faces, slopes[1] @ faces), axis=2) * weights
    blocks = np.einsum("bg,gi,gj->bij", area, shapes, shapes)
    at = place[mesh.faces]
    rows, columns = np.repeat(at, 6, axis=1).ravel(), np.tile(at, (1, 6)).ravel()
    load = np.bincount(at.ravel(), (area @ shapes).ravel(), minlength=len(node))
    return coo_array((blocks.ravel(), (rows, columns)), shape=(len(node),) * 2), load


def cooled(
    mesh: TetMesh,
    times: np.ndarray,
    k: float,
    rho_c: float,
    h: float,
    start: float,
    air: float,
    steps: int = 40,
) -> np.ndarray:
    """Return (times, nodes) temperatures, by the trapezoidal rule after four implicit quarter steps.

    Parameters
    ----------
    mesh : TetMesh
        Of order 2.
    times : (n,) array
        Seconds, increasing; `steps` time steps lead from one to the next.
    """
    ours, node = skfem_mesh(mesh)
    basis = Basis(ours, ElementTetP2(), intorder=5)
    stiffness = BilinearForm(lambda u, v, _: k * dot(grad(u), grad(v))).assemble(basis)
    mass = BilinearForm(lambda u, v, _: rho_c * u * v).assemble(basis)
    film, area = skin(mesh, node)
    system, load = (stiffness + h * film).tocsc(), h * air * area
    now, field, found = 0.0, np.full(basis.N, start), []
    for time in times:
        step = (time - now) / steps
        first = not found
        if first:  # the surface's jump at the start is damped (Rannacher 1984)
            quarter = splu((mass + 0.25 * step * system).tocsc())
            for _ in range(4):
                field = quarter.solve(mass @ field + 0.25 * step * load)
        half = splu((mass + 0.5 * step * system).tocsc())
        for _ in range(steps - first):
            field = half.solve(mass @ field - 0.5 * step * (system @ field) + step * load)
        found.append(field)
        now = time
    result = np.empty((len(found), len(mesh.nodes)))
    result[:, node] = found
    return result


def at_points(mesh: TetMesh, field: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the field at points (n, 3) mm; NaN outside the body."""
    corners = mesh.nodes[mesh.elements[:, :4]]
    near = cKDTree(corners.mean(axis=1)).query(points, k=min(60, len(corners)))[1]
    best, value = np.full(len(points), -np.inf), np.full(len(points), np.nan)
    for column in near.T:
        frame = (corners[column, 1:] - corners[column, :1]).transpose(0, 2, 1)
        local = np.linalg.solve(frame, (points - corners[column, 0])[:, :, None])[:, :, 0]
        inside = np.minimum(local.min(axis=1), 1.0 - local.sum(axis=1))
        better = (inside > best) & (inside > -0.1)  # the outermost elements are curved
        shapes = shape_values(3, 2, local[better])
        value[better] = (shapes * field[mesh.elements[column[better]]]).sum(axis=1)
        best[better] = inside[better]
    return value


def reconstructed(source: Path) -> TetMesh:
    """Return the mesh that method fem made of a stack."""
    from stackloft.pipeline.request import MeasureRequest
    from stackloft.pipeline.run import measure

    finer_inside = {"mesher.sweep": {"growth": 1.5}}
    outcome = measure(MeasureRequest(source, method="fem", settings=finer_inside))
    mesh = outcome.product(TetMesh)
    assert mesh is not None
    return mesh


def main(source: Path, picture: Path) -> None:
    """Cool the piece and draw the temperatures in a slice along its axis after half an hour steps."""
    from matplotlib.figure import Figure

    mesh = reconstructed(source)
    times = 3600.0 * HOURS * np.array([0.125, 0.5, 1.0])
    fields = cooled(mesh, times, K, RHO_C, H, T0, T_AIR)
    low, high = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
    x, z = np.meshgrid(np.linspace(low[0], high[0], 160), np.linspace(low[2], high[2], 160))
    points = np.column_stack([x.ravel(), np.full(x.size, 0.5 * (low[1] + high[1])), z.ravel()])
    figure = Figure(figsize=(11, 3.8), layout="constrained")
    for axes, time, field in zip(figure.subplots(1, 3, sharey=True), times, fields, strict=True):
        shown = axes.contourf(
            x, z, at_points(mesh, field, points).reshape(x.shape), np.linspace(T_AIR, T0, 23), cmap="inferno"
        )
        axes.set(title=f"{time / 60:.0f} min, core {field.max():.1f} °C", xlabel="x [mm]", aspect="equal")
    axes.figure.axes[0].set_ylabel("z [mm]")
    figure.colorbar(shown, ax=figure.axes, label="temperature [°C]")
    figure.savefig(picture, dpi=110)
    print(f"{len(mesh.elements)} elements; core {', '.join(f'{f.max():.2f}' for f in fields)} °C")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
