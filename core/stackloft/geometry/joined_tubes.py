r"""Several tubes of patches as one closed triangle surface: faces with openings, joints with shared edges.

::

     face with an opening          joint: the last ring of every tube that ends
      +-----------+                there is replaced by the shared edges, and the
      |  +-----+  |                strip between is zipped
      |  |     |  |                     o--o--o--o--o     ring of the tube
      |  +-----+  |                      \/ \ /\ | /
      +-----------+                      o---o---o        edges of the joint
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stackloft.geometry.plane_faces import cut_face, group_rims
from stackloft.geometry.tessellation import quads, ring_grid

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Tube:
    """A tube of patches and its ends."""

    patches: FloatArray
    """(rows, columns, 4, 4, 3) mm"""
    faces: tuple[float | None, float | None]
    """1: a plane face, -1: an opening in one, 0: a joint, None: a pole"""


@dataclass(frozen=True, slots=True, eq=False)
class TubeJoint:
    """Edges shared by tubes' rims."""

    edges: tuple[FloatArray, ...]
    """(k, 3) mm, ends included"""
    rims: tuple[tuple[int, bool, tuple[tuple[int, bool], ...]], ...]
    """(tube, at its last row?, ((edge, forward), …))"""


class _Surface:
    """Vertices and faces as they are gathered."""

    def __init__(self) -> None:
        self.vertices: list[FloatArray] = []
        self.faces: list[IntArray] = []
        self.count = 0

    def add(self, points: FloatArray) -> IntArray:
        """Add vertices and return their numbers."""
        index = np.arange(self.count, self.count + len(points))
        self.vertices.append(points)
        self.count += len(points)
        return index

    def points(self) -> FloatArray:
        return np.concatenate(self.vertices)


def tessellate_tubes(
    tubes: list[Tube], joints: list[TubeJoint], tolerance: float
) -> tuple[FloatArray, IntArray]:
    """Return vertices (n, 3) mm and outward faces (t, 3) of a closed surface.

    Parameters
    ----------
    tubes : list of Tube
    joints : list of TubeJoint
    tolerance : float
        Largest wanted distance between triangles and patches, mm.
    """
    surface = _Surface()
    rims = _joint_rims(surface, joints)
    plane: list[tuple[float, IntArray]] = []  # sign, ring as seen from outside
    for number, tube in enumerate(tubes):
        grid = ring_grid(tube.patches, tolerance, rings=4)
        first = 0 if _kept(tube.faces[0]) else 1
        last = len(grid) - (0 if _kept(tube.faces[1]) else 1)
        index = surface.add(grid[first:last].reshape(-1, 3)).reshape(-1, grid.shape[1])
        surface.faces.append(quads(grid[first:last].reshape(-1, 3), index - index[0, 0]) + index[0, 0])
        for at_last, sign in enumerate(tube.faces):
            ring = index[-1] if at_last else index[0][::-1]
            if sign is None:
                apex = surface.add(grid[-1, :1] if at_last else grid[0, :1])[0]
                surface.faces.append(_fan(ring, int(apex)))
            elif sign == 0.0:
                composite = rims[number, bool(at_last)]
                surface.faces.append(
                    _zipped(surface.points(), ring, composite if at_last else composite[::-1])
                )
            else:
                plane.append((sign, ring))
    points = surface.points()
    for outer, openings in group_rims(points, plane):
        surface.faces.append(cut_face(points, outer, openings))
    return points, np.concatenate(surface.faces)


def _kept(sign: float | None) -> bool:
    """Return whether the end's own ring is part of the surface."""
    return sign is not None and sign != 0.0


def _joint_rims(surface: _Surface, joints: list[TubeJoint]) -> dict[tuple[int, bool], IntArray]:
    """Add the joints' vertices and return each rim's ring of vertex numbers, along u."""
    rims: dict[tuple[int, bool], IntArray] = {}
    for joint in joints:
        ends = np.concatenate([edge[[0, -1]] for edge in joint.edges])
        size = float(np.ptp(ends, axis=0).max()) + 1e-300
        nodes, node_of = _nodes(ends, 1e-7 * size)
        corner = surface.add(nodes)
        runs = []
        for k, edge in enumerate(joint.edges):
            inner = surface.add(edge[1:-1])
            a, b = node_of[2 * k : 2 * k + 2]
            runs.append(np.concatenate([corner[[a]], inner, corner[[b]]]))
        for tube, at_last, uses in joint.rims:
            parts = [runs[k][:-1] if forward else runs[k][::-1][:-1] for k, forward in uses]
            rims[tube, at_last] = np.concatenate(parts)
    return rims


def _nodes(points: FloatArray, near: float) -> tuple[FloatArray, IntArray]:
    """Return points that are `near` each other as one."""
    nodes: list[FloatArray] = []
    which = []
    for point in points:
        for k, node in enumerate(nodes):
            if np.abs(node - point).max() <= near:
                which.append(k)
                break
        else:
            which.append(len(nodes))
            nodes.append(point)
    return np.array(nodes), np.array(which)


def _fan(ring: IntArray, apex: int) -> IntArray:
    return np.stack([ring, np.roll(ring, -1), np.full(len(ring), apex)], axis=1)


def _zipped(points: FloatArray, ring: IntArray, rim: IntArray) -> IntArray:
    """Return the strip from a ring to a rim, both closed and in the same direction, by arc fraction."""
    apart = ((points[rim] - points[ring[0]]) ** 2).sum(axis=1)
    rim = np.roll(rim, -int(np.argmin(apart)))
    a, b = _fractions(points[ring]), _fractions(points[rim])
    i = j = 0
    faces = []
    n, m = len(ring), len(rim)
    while i < n or j < m:
        if j == m or (i < n and a[i + 1] <= b[j + 1]):
            faces.append((ring[i % n], ring[(i + 1) % n], rim[j % m]))
            i += 1
        else:
            faces.append((ring[i % n], rim[(j + 1) % m], rim[j % m]))
            j += 1
    return np.array(faces, dtype=np.int64)


def _fractions(points: FloatArray) -> FloatArray:
    step = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    return np.concatenate([[0.0], np.cumsum(step) / step.sum()])
