r"""What the boundary of a mesh must lie on: exact patches, planes and triangles, sharp edges and corners.

::

    a loft         →  tessellation  →  regions: planes, or the patches that their triangles lie on
                                       sharp edges: the rims of patches they follow, or straight
    a triangle surface              →  regions: planes, or the triangles themselves; edges are straight
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree

from stackloft.geometry.exact_curves import CurveSet
from stackloft.geometry.exact_surface import ExactSurface
from stackloft.geometry.surface_regions import SurfaceRegions, surface_regions
from stackloft.model.arrays import BoolArray, FloatArray, IntArray
from stackloft.model.tri_mesh import TriMesh
from stackloft_plugins.meshers.closest_triangle import ClosestTriangle

MANY = 200
"""Regions above which a surface is taken for rough, and for one region."""
_CRUMB = 1e-3
"""Part of a loft's area below which a region is none of its own."""
_SAME = 1e-8
"""Part of the surface's size within which points are the same."""
_BARE = 0.25
"""Part of an edge's length that its middle is off the rims when none of them runs along it."""
Projection = Callable[[FloatArray], FloatArray]


@dataclass(slots=True, eq=False)
class BoundaryTarget:
    """A closed surface with its sharp edges and corners."""

    surface: TriMesh
    regions: SurfaceRegions
    patches: FloatArray | None
    """(k, 4, 4, 3) mm, when the triangles are a tessellation of patches and plane faces"""
    near: ClosestTriangle
    flat: BoolArray
    """(t,) triangles of plane ends: no patch lies there"""
    _regions: dict[int, Projection] = field(default_factory=dict)
    _edges: dict[tuple[int, int], Projection | None] = field(default_factory=dict)

    @property
    def size(self) -> float:
        """The longest side of its box, mm."""
        return float(np.ptp(self.surface.vertices, axis=0).max())

    def on_region(self, number: int) -> Projection:
        """Return the projection on a region."""
        if number not in self._regions:
            self._regions[number] = self._region(number)
        return self._regions[number]

    def on_edges(self, first: int, second: int) -> Projection | None:
        """Return the projection on the sharp edges between two regions; None where they do not meet."""
        key = (min(first, second), max(first, second))
        if key not in self._edges:
            self._edges[key] = self._edge(key)
        return self._edges[key]

    def corners(self) -> FloatArray:
        """Return (c, 3) the corners."""
        return np.asarray(self.surface.vertices[self.regions.corners])

    def _region(self, number: int) -> Projection:
        own = self.regions.region == number
        mine = self.surface.faces[own]
        if self.regions.plane[number]:
            return _plane(self.surface.vertices, mine)
        if self.patches is None:
            found = ClosestTriangle(self.surface.vertices, mine)
            return lambda points: found.project(points)[0]
        bent = self.surface.faces[own & ~self.flat]
        used = np.unique(ExactSurface(self.patches).project(self.surface.vertices[bent].mean(axis=1)).patch)
        exact = ExactSurface(self.patches[used])
        if len(bent) == len(mine):
            return lambda points: exact.project(points).points
        return _nearer(exact, ClosestTriangle(self.surface.vertices, self.surface.faces[own & self.flat]))

    def _edge(self, key: tuple[int, int]) -> Projection | None:
        mine = self.regions.edges[(self.regions.sides == key).all(axis=1)]
        if not len(mine):
            return None
        ends = self.surface.vertices[mine]
        straight = CurveSet(_cubics(ends))
        exact = self._rims(mine, straight)
        curves = straight if exact is None else exact
        return lambda points: curves.project(points).points

    def _rims(self, edges: IntArray, straight: CurveSet) -> CurveSet | None:
        """Return the rims of patches that run along `edges`; None when they do not cover them."""
        if self.patches is None:
            return None
        p, tolerance = self.patches, _SAME * self.size
        rims = np.concatenate([p[:, :, 0], p[:, :, 3], p[:, 0], p[:, 3]])
        rims = rims[np.linalg.norm(np.diff(rims, axis=1), axis=2).sum(axis=1) > tolerance]
        points = self.surface.vertices[np.unique(edges)]
        tree = cKDTree(points)
        joined = (np.asarray(tree.query(rims[:, [0, 3]])[0]) <= tolerance).all(axis=1)
        rims = rims[joined]
        middle = np.einsum("k,nkd->nd", np.array([1, 3, 3, 1]) / 8, rims)
        longest = float(np.linalg.norm(np.diff(self.surface.vertices[edges], axis=1), axis=2).max())
        off = straight.project(middle).distance if len(rims) else np.zeros(0)
        rims = rims[off <= 0.3 * longest]
        if not len(rims):
            return None
        ends = self.surface.vertices[edges]
        bare = CurveSet(rims).project(ends.mean(axis=1)).distance > _BARE * np.linalg.norm(
            ends[:, 1] - ends[:, 0], axis=1
        )  # else nodes beside a gap would all go to its two ends
        curves = CurveSet(np.concatenate([rims, _cubics(ends[bare])]))
        return curves if curves.project(points).distance.max() <= tolerance else None


def _cubics(ends: FloatArray) -> FloatArray:
    """Return (k, 4, 3) Bézier points of straight lines between (k, 2, 3) points."""
    part = np.linspace(0.0, 1.0, 4)[None, :, None]
    return np.asarray(ends[:, :1] * (1.0 - part) + ends[:, 1:] * part)


def boundary_target(
    surface: TriMesh,
    patches: FloatArray | None = None,
    ends: tuple[tuple[FloatArray, FloatArray], ...] = (),
) -> BoundaryTarget:
    """Return what a mesh of the body within `surface` has to fit.

    Parameters
    ----------
    surface : TriMesh
        Closed and oriented.
    patches : (k, 4, 4, 3) array, optional
        Where the triangles come from, in the same millimetres.
    ends : pairs of (3,) arrays
        Point and unit normal of each plane that closes a shell of patches.
    """
    least = 0.0 if patches is None else _CRUMB  # where tubes join, a tessellation has odd triangles
    regions = surface_regions(surface.vertices, surface.faces, least=least)
    if regions.count > MANY:
        regions = surface_regions(surface.vertices, surface.faces, angle=180.0)
    flat = np.zeros(len(surface.faces), dtype=bool)
    slack = _SAME * float(np.ptp(surface.vertices, axis=0).max())
    for point, normal in ends:
        flat |= (np.abs((surface.vertices - point) @ normal) <= slack)[surface.faces].all(axis=1)
    return BoundaryTarget(surface, regions, patches, ClosestTriangle(surface.vertices, surface.faces), flat)


def _nearer(exact: ExactSurface, cap: ClosestTriangle) -> Projection:
    """Return the projection on patches or the plane end they run into, whichever is nearer."""

    def project(points: FloatArray) -> FloatArray:
        on_patch = exact.project(points)
        on_cap, _, distance = cap.project(points)
        return np.where((distance < on_patch.distance)[:, None], on_cap, on_patch.points)

    return project


def _plane(vertices: FloatArray, faces: IntArray) -> Projection:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a).sum(axis=0)
    normal /= np.linalg.norm(normal)
    origin = vertices[np.unique(faces)].mean(axis=0)
    return lambda points: points - ((points - origin) @ normal)[:, None] * normal
