r"""The nearest point of an exact surface of bicubic patches.

::

      * point                     start: the nearest of a lattice of samples on every patch
      |                           then Newton's method for (P − X)·P_u = (P − X)·P_v = 0, held to the patch;
    --o------ patch --|-- next    the patches of the next nearest samples are tried as well, so that a point
         samples . . .            near a patch's rim finds its foot on either side

At a pole a row of control points is one point and (u, v) are polar there. Newton's step in a Cartesian chart
solves the same two equations in the tangent plane; Levenberg's damping, scaled by the surface's own metric,
is that chart: it keeps the step short in millimetres whatever u does. The pole itself is a candidate always.
Whatever is returned lies on the surface to rounding, as it is evaluated there.

Newton projection: Piegl & Tiller (1997), The NURBS Book, §6.1; damping: Levenberg (1944).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from stackloft.geometry.bezier_patch import bernstein, bernstein_slope
from stackloft.geometry.patch_rims import PatchRims, patch_rims

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

STEPS = 12
"""Most Newton steps; near a surface five are enough."""
STARTS = 4
"""Patches tried for each point."""
SAMPLES = 3
"""Samples per patch and direction."""
HOPS = 64
"""Most patches that a foot goes on through: half the sectors round a pole of 128."""


@dataclass(frozen=True, slots=True, eq=False)
class Feet:
    """The nearest points of a surface or of curves."""

    points: FloatArray
    """(n, 3) mm"""
    patch: IntArray
    """(n,) which patch (or segment) each lies on"""
    at: FloatArray
    """(n, 2) its parameters (v, u) there, or (n, 1) on a curve"""
    distance: FloatArray
    """(n,) mm from the point that was given"""


def points_on(patches: FloatArray, which: IntArray, v: FloatArray, u: FloatArray) -> FloatArray:
    """Return the points of patches `which` at (v, u), (n, 3).

    Examples
    --------
    >>> flat = np.zeros((1, 4, 4, 3))
    >>> flat[0, :, :, 0], flat[0, :, :, 1] = np.meshgrid(np.arange(4) / 3, np.arange(4) / 3)
    >>> points_on(flat, np.array([0]), np.array([0.5]), np.array([0.25])).round(12).tolist()
    [[0.25, 0.5, 0.0]]
    """
    return _mixed(patches[which], bernstein(v), bernstein(u))


def _mixed(control: FloatArray, along_v: FloatArray, along_u: FloatArray) -> FloatArray:
    weights = (along_v[:, :, None] * along_u[:, None, :]).reshape(len(along_v), 1, 16)
    return np.asarray(np.matmul(weights, control.reshape(len(along_v), 16, 3))[:, 0])


class ExactSurface:
    """Bicubic patches that points are projected on.

    Parameters
    ----------
    patches : (k, 4, 4, 3) array
        Bézier control points [v, u], mm, of any number of shells one after the other.

    Examples
    --------
    >>> flat = np.zeros((1, 4, 4, 3))
    >>> flat[0, :, :, 0], flat[0, :, :, 1] = np.meshgrid(np.arange(4) / 3, np.arange(4) / 3)
    >>> ExactSurface(flat).project(np.array([[0.2, 0.7, 5.0], [2.0, 0.5, 0.0]])).points.round(9).tolist()
    [[0.2, 0.7, 0.0], [1.0, 0.5, 0.0]]
    """

    def __init__(self, patches: FloatArray) -> None:
        self.patches = np.ascontiguousarray(patches.reshape(-1, 4, 4, 3))

    @cached_property
    def _tree(self) -> cKDTree:
        along = bernstein((np.arange(SAMPLES) + 0.5) / SAMPLES)  # within, so that no two patches share one
        grid = np.einsum("ak,nkld,bl->nabd", along, self.patches, along)
        return cKDTree(grid.reshape(-1, 3))

    def project(self, points: FloatArray, starts: int = STARTS) -> Feet:
        """Return the nearest point of the surface for each of `points` (n, 3).

        Parameters
        ----------
        points : (n, 3) array, mm
        starts : int
            Patches tried for each point: those of the nearest samples.
        """
        side = SAMPLES
        count = min(starts * 4, side * side * len(self.patches))
        near = np.atleast_2d(self._tree.query(points, k=count)[1].reshape(len(points), -1))
        patch, place = near // (side * side), near % (side * side)
        first = _first_of_each(patch, starts)
        owner, column = np.nonzero(first)
        which, place = patch[owner, column], place[owner, column]
        at = (np.column_stack([place // side, place % side]) + 0.5) / side
        at, foot = self._descended(points[owner], which, at)
        distance = np.linalg.norm(foot - points[owner], axis=1)
        order = np.lexsort((distance, owner))
        best = order[np.concatenate([[True], np.diff(owner[order]) > 0])] if len(order) else order
        return self._hopped(points, Feet(foot[best], which[best], at[best], distance[best]))

    def _hopped(self, points: FloatArray, feet: Feet) -> Feet:
        """Return the feet after those held at a patch's rim have gone on into the neighbours."""
        foot, which, at, distance = feet.points, feet.patch, feet.at, feet.distance
        going = np.arange(len(points))
        for _ in range(HOPS):
            rim = self._left_through(points[going], which[going], at[going], foot[going])
            going, rim = going[rim >= 0], rim[rim >= 0]
            place, rims = (which[going], rim), self._neighbours
            next_patch, next_rim, turned = rims.beyond[place], rims.entered[place], rims.back[place]
            inside = next_patch >= 0
            going, rim, next_patch = going[inside], rim[inside], next_patch[inside]
            if not len(going):
                break
            along = at[going, np.where(rim < 2, 0, 1)]
            along = np.where(turned[inside], 1.0 - along, along)
            bound = (next_rim[inside] % 2).astype(np.float64)
            across_u = (next_rim[inside] < 2)[:, None]
            start = np.where(across_u, np.column_stack([along, bound]), np.column_stack([bound, along]))
            found, there = self._descended(points[going], next_patch, start)
            new = np.linalg.norm(there - points[going], axis=1)
            nearer = new < distance[going] * (1.0 - 1e-12)
            going = going[nearer]
            which[going], at[going] = next_patch[nearer], found[nearer]
            foot[going], distance[going] = there[nearer], new[nearer]
        return Feet(foot, which, at, distance)

    def _left_through(
        self, points: FloatArray, which: IntArray, at: FloatArray, foot: FloatArray
    ) -> IntArray:
        """Return the rim (u = 0, u = 1, v = 0, v = 1) through which each foot wants to leave, or -1."""
        control = self.patches[which]
        value = (bernstein(at[:, 0]), bernstein(at[:, 1]))
        slope = (bernstein_slope(at[:, 0]), bernstein_slope(at[:, 1]))
        pull_v = _dot(points - foot, _mixed(control, slope[0], value[1]))
        pull_u = _dot(points - foot, _mixed(control, value[0], slope[1]))
        pulls = np.column_stack(
            [
                np.where(at[:, 1] <= 0.0, -pull_u, 0.0),
                np.where(at[:, 1] >= 1.0, pull_u, 0.0),
                np.where(at[:, 0] <= 0.0, -pull_v, 0.0),
                np.where(at[:, 0] >= 1.0, pull_v, 0.0),
            ]
        )
        return np.where(pulls.max(axis=1, initial=0.0) > 0.0, pulls.argmax(axis=1), -1)

    @cached_property
    def _neighbours(self) -> PatchRims:
        return patch_rims(self.patches)

    def _descended(
        self, points: FloatArray, which: IntArray, at: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return parameters and points after damped Newton steps on each patch."""
        control, at = self.patches[which], at.copy()
        foot = _mixed(control, bernstein(at[:, 0]), bernstein(at[:, 1]))
        damping = np.full(len(at), 1e-3)
        active = np.arange(len(at))
        for _ in range(STEPS):
            step = self._step(control[active], points[active], at[active], foot[active], damping[active])
            tried = np.clip(at[active] + step, 0.0, 1.0)
            found = _mixed(control[active], bernstein(tried[:, 0]), bernstein(tried[:, 1]))
            better = _squared(found - points[active]) <= _squared(foot[active] - points[active])
            damping[active] *= np.where(better, 0.1, 10.0)
            moved = np.abs(tried - at[active]).max(axis=1)
            at[active[better]], foot[active[better]] = tried[better], found[better]
            active = active[(moved > 1e-10) & (damping[active] < 1e6)]
            if not len(active):
                break
        return at, foot

    @staticmethod
    def _step(
        control: FloatArray, points: FloatArray, at: FloatArray, foot: FloatArray, damping: FloatArray
    ) -> FloatArray:
        """Return one damped step in (v, u); a parameter at its bound that would leave stays."""
        value = (bernstein(at[:, 0]), bernstein(at[:, 1]))
        slope = (bernstein_slope(at[:, 0]), bernstein_slope(at[:, 1]))
        bend = (_bend(at[:, 0]), _bend(at[:, 1]))
        off = foot - points
        p_v, p_u = _mixed(control, slope[0], value[1]), _mixed(control, value[0], slope[1])
        size = _squared(control[:, 3, 3] - control[:, 0, 0]) + _squared(control[:, 3, 0] - control[:, 0, 3])
        gradient = np.column_stack([_dot(off, p_v), _dot(off, p_u)])
        a = _dot(p_v, p_v) + np.maximum(_dot(off, _mixed(control, bend[0], value[1])), 0.0)
        c = _dot(p_u, p_u) + np.maximum(_dot(off, _mixed(control, value[0], bend[1])), 0.0)
        b = _dot(p_v, p_u) + _dot(off, _mixed(control, slope[0], slope[1]))
        b = np.clip(b, -0.999 * np.sqrt(a * c), 0.999 * np.sqrt(a * c))
        a, c = a + damping * (a + 1e-6 * size) + 1e-300, c + damping * (c + 1e-6 * size) + 1e-300
        held = ((at <= 0.0) & (gradient > 0.0)) | ((at >= 1.0) & (gradient < 0.0))
        gradient = np.where(held, 0.0, gradient)
        b = np.where(held.any(axis=1), 0.0, b)
        whole = a * c - b * b
        return np.column_stack(
            [(b * gradient[:, 1] - c * gradient[:, 0]), (b * gradient[:, 0] - a * gradient[:, 1])]
        ) / np.where(whole > 0.0, whole, 1.0)[:, None]  # fmt: skip


def _first_of_each(patch: IntArray, most: int) -> BoolArray:
    """Return which entries of each row are the first of their patch, the first `most` of them."""
    new: BoolArray = np.ones(patch.shape, dtype=bool)
    for k in range(1, patch.shape[1]):
        new[:, k] = (patch[:, :k] != patch[:, k : k + 1]).all(axis=1)
    return np.logical_and(new, np.cumsum(new, axis=1) <= most)


def _bend(x: FloatArray) -> FloatArray:
    """Return the second derivatives of the four cubic Bernstein polynomials, (n, 4)."""
    y = 1.0 - x
    return np.stack([6.0 * y, 6.0 * x - 12.0 * y, 6.0 * y - 12.0 * x, 6.0 * x], axis=-1)


def _squared(a: FloatArray) -> FloatArray:
    return np.asarray((a * a).sum(axis=-1))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray((a * b).sum(axis=-1))
