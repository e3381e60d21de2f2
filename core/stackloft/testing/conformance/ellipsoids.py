"""One ellipsoid as every product that an integrator may take, at any resolution.

The semi-axes are A, B, B with the long one in the section plane, so volume and area are closed
forms and no section is a circle::

       y                          z = position
       |   ___                    |  _
       |  (   ) B                 | ( )  B
       |   ---                    |  -
       +---- A ---- x             +------ x
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from stackloft.model.arrays import FloatArray, frozen_floats, frozen_ints
from stackloft.model.contour_stack import ContourStack, Loop, Section
from stackloft.model.lofted_solid import LoftedSolid, Shell, ShellEnd
from stackloft.model.segmentation import Segmentation
from stackloft.model.tet_mesh import TetMesh
from stackloft.model.tri_mesh import TriMesh
from stackloft.testing.conformance.tet_ellipsoid import tet_ellipsoid
from stackloft.testing.conformance.voxel_ellipsoid import PLACES, scan

A, B = 14.0, 8.0
"""Semi-axes, mm."""
CENTRE = np.array([31.0, -17.0, 123.0])
"""mm; an odd place, because fixtures at the origin hide mistakes."""

_E = math.sqrt(1 - (B / A) ** 2)
VOLUME = 4 / 3 * math.pi * A * B * B
"""mm³"""
AREA = 2 * math.pi * B * B * (1 + A / (B * _E) * math.asin(_E))
"""mm², prolate spheroid."""


def contour_stack(fineness: int) -> ContourStack:
    """Return ``8·fineness`` exact sections at mid-thickness, 24·fineness points each.

    The points are unevenly spaced, differently in each section: on an evenly divided ellipse every
    vertex counts alike, and who forgets one would not be seen.
    """
    count = 8 * fineness
    pitch = 2 * B / count
    even = 2 * np.pi * np.arange(24 * fineness) / (24 * fineness)
    sections = []
    for k in range(count):
        z = -B + (k + 0.5) * pitch
        r = math.sqrt(1 - (z / B) ** 2)
        angle = even + 0.15 * np.sin(2 * even + k)
        ring = np.column_stack([A * r * np.cos(angle), B * r * np.sin(angle)]) + CENTRE[:2]
        sections.append(Section(CENTRE[2] + z, (Loop(frozen_floats(ring)),), f"section {k + 1}"))
    return ContourStack(tuple(sections), affine=frozen_floats(np.eye(4)))


def lofted_solid(fineness: int) -> LoftedSolid:
    """Return ``2·fineness`` rows of ``4·fineness`` bicubic patches from pole to pole.

    Each arc of a circle by angle θ is a cubic Bézier curve with handles of length 4/3·tan(θ/4), whose
    radius errs by O(θ⁶) (Goldapp 1991).
    """
    rows, columns = 2 * fineness, 4 * fineness
    meridian = _arcs(-np.pi / 2, np.pi / 2, rows)
    around = _arcs(0.0, 2 * np.pi, columns)
    patches = np.empty((rows, columns, 4, 4, 3))
    patches[..., 0] = A * meridian[:, None, :, None, 0] * around[None, :, None, :, 0]
    patches[..., 1] = B * meridian[:, None, :, None, 0] * around[None, :, None, :, 1]
    patches[..., 2] = B * meridian[:, None, :, None, 1]
    shell = Shell(frozen_floats(patches + CENTRE), (ShellEnd.POLE, ShellEnd.POLE))
    return LoftedSolid((shell,), affine=frozen_floats(np.eye(4)))


def _arcs(start: float, stop: float, count: int) -> FloatArray:
    """Return (count, 4, 2) Bézier control points of unit-circle arcs from `start` to `stop`, radians."""
    ends = np.linspace(start, stop, count + 1)
    if np.isclose(stop - start, 2 * np.pi):
        ends[-1] = start  # the last arc ends on the very point where the first begins
    point = np.column_stack([np.cos(ends), np.sin(ends)])
    if np.isclose(stop - start, np.pi):
        point[[0, -1], 0] = 0.0  # the poles
    handle = 4 / 3 * math.tan((stop - start) / count / 4) * np.column_stack([-point[:, 1], point[:, 0]])
    return np.stack([point[:-1], point[:-1] + handle[:-1], point[1:] - handle[1:], point[1:]], axis=1)


def tri_mesh(fineness: int) -> TriMesh:
    """Return a closed triangle surface inscribed in the ellipsoid, 6·fineness rings between the poles."""
    rings, around = 6 * fineness, 12 * fineness
    polar = np.pi * np.arange(1, rings + 1) / (rings + 1)
    angle = 2 * np.pi * np.arange(around) / around
    r, z = np.sin(polar)[:, None], np.cos(polar)[:, None]
    grid = np.stack([A * r * np.cos(angle), B * r * np.sin(angle), B * z * np.ones(around)], axis=-1)
    vertices = np.vstack([grid.reshape(-1, 3), [[0, 0, B], [0, 0, -B]]]) + CENTRE
    index = np.arange(rings * around).reshape(rings, around)
    beside = np.roll(index, -1, axis=1)
    top, bottom = rings * around, rings * around + 1
    faces = [
        np.stack([index[:-1], index[1:], beside[:-1]], axis=-1).reshape(-1, 3),
        np.stack([beside[:-1], index[1:], beside[1:]], axis=-1).reshape(-1, 3),
        np.column_stack([np.full(around, top), index[0], beside[0]]),
        np.column_stack([np.full(around, bottom), beside[-1], index[-1]]),
    ]
    return TriMesh(frozen_floats(vertices), frozen_ints(np.vstack(faces)))


def segmentation(fineness: int) -> Segmentation:
    """Return a scan of about ``8·fineness`` slabs whose grey levels are coverage."""
    return scan((A, B, B), CENTRE, fineness)


def segmentations(fineness: int) -> list[Segmentation]:
    """Return the same scan at several places among the voxels.

    What counts voxels errs by chance of where the body lies among them, with either sign, so that one
    place says nothing about whether a finer scan errs less.
    """
    return [scan((A, B, B), CENTRE, fineness, place) for place in range(len(PLACES))]


def tet_mesh(fineness: int) -> TetMesh:
    """Return tetrahedra of order 2 on the triangles of `tri_mesh`, with two boundary groups."""
    return tet_ellipsoid(tri_mesh(fineness), CENTRE, np.array([A, B, B]))


MAKERS: dict[type, Callable[[int], Any]] = {
    Segmentation: segmentation,
    ContourStack: contour_stack,
    LoftedSolid: lofted_solid,
    TriMesh: tri_mesh,
    TetMesh: tet_mesh,
}
"""Fineness to product, by product type."""
